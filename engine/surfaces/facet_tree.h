#pragma once
// Embree's tree over facets: the first that rays from a place meet, and whether the way to a place is free.

#include "engine/surfaces/elements.h"

#include <array>
#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <span>

namespace pmdsim {

inline constexpr std::size_t packet_columns = 4, packet_rows = 2; // of the grid of directions
inline constexpr std::size_t packet_rays = packet_columns * packet_rows;

// Rays that leave one place in neighbouring directions, and what they meet first.
struct RayPacket {
  std::array<glm::vec3, packet_rays> directions; // unit length
  std::array<std::uint32_t, packet_rays> facet;  // or no_facet
  std::array<std::uint8_t, packet_rays> side;    // that was met: 0 front, 1 back
  std::array<float, packet_rays> u, v;           // weights of the facet's second and third corner
  std::array<float, packet_rays> length_m;
};

class FacetTree {
public:
  // The scene, which has to outlive this, is asked where cutouts are. Throws Error: out_of_memory.
  FacetTree(const Scene &scene, const Elements &elements);
  ~FacetTree();
  FacetTree(const FacetTree &) = delete;
  FacetTree &operator=(const FacetTree &) = delete;

  // Any number of threads may call these at once; positions from Elements::origin_m.
  void trace(const glm::dvec3 &from_m, RayPacket &packet) const;
  // Sets is_free[i] where nothing lies between `from_m` and to_m[i].
  void look(const glm::dvec3 &from_m, std::span<const glm::vec3> to_m, std::span<std::uint8_t> is_free) const;

  // Whether a facet is there at the place of a hit.
  bool is_there(std::uint32_t facet, float u, float v) const;

private:
  const Scene &scene_;
  std::vector<std::uint32_t> triangles_;                  // of each facet
  std::vector<std::array<CornerWeights, 3>> in_triangle_; // likewise, where the scene has cutouts
  RTCDevice device_ = nullptr;
  RTCScene tree_ = nullptr;
};

} // namespace pmdsim
