#pragma once
// What a place on a surface sees of the scene around it, along lines over its hemisphere: half planes about
// an axis in the surface, at equal angles. In each, a triangle is a straight stretch, so that what hides
// what, and where one facet ends and the next begins, is known all along the line, where rays are samples of
// it (N. Billen and P. Dutré, "Line sampling for direct illumination", Computer Graphics Forum 35, 2016).

#include "engine/surfaces/facet_cuts.h"
#include "engine/surfaces/sharp_edges.h"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace pmdsim {

// Parts of lines that lie in one facet each, with a point that stands for all of it. One entry each.
struct Sightings {
  std::vector<std::uint32_t> face; // face_of; only of sides that reflect
  std::vector<float> u, v;         // of the point: weights of the facet's second and third corner
  std::vector<float> length_m;     // of the way there
  // Of what arrives at the place, for each unit that leaves the face; in a closed scene they sum to 1.
  std::vector<float> share;
  std::vector<std::uint32_t> line_ends; // of each line: one past its last
};

class HemisphereScan {
public:
  // The scene has to outlive this; the facets have to be cut by then.
  HemisphereScan(const Scene &scene, const Elements &elements);

  // Looks from a place along so many lines, about an axis chosen near `turn`, 0 to 1, which should be another
  // for each place: then what lines leave out at one has nothing to do with what they leave out at the next.
  // Any number of threads may call this at once.
  void at(const SurfacePlace &place, double turn, std::uint32_t lines, Sightings &sightings) const;

private:
  friend class PlaceScan;
  struct Corners {
    std::array<std::uint32_t, 3> vertices;
    std::uint32_t triangle; // of the scene
  };

  const Scene &scene_;
  FacetCuts cuts_;
  SharpEdges edges_;
  std::vector<std::uint8_t> reflects_; // each face
  float lowest_m_;                     // over a surface: what is nearer to its plane is not seen
  std::vector<float> x_m_, y_m_, z_m_; // vertices, from the elements' origin
  std::vector<Corners> triangles_;
};

// A turn of lines for the place with that number, far from those of its neighbours (the golden ratio's
// sequence).
inline double turn_of(std::uint64_t number) {
  const double turns = std::numbers::phi * static_cast<double>(number % 1'000'003);
  return turns - std::floor(turns);
}

} // namespace pmdsim
