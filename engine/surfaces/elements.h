#pragma once
// The surfaces of a scene, cut up for the light that bounces between them. A facet is the piece that a ray
// meets: a part of a large triangle, or a whole small one. An element is the piece of a surface's side whose
// share of bounced light is solved for: a part of a large triangle over which irradiance is linear, or a
// group of small triangles that face about the same way, over which it is constant.

#include "engine/model/scene.h"
#include "engine/surfaces/surface_paint.h"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

inline constexpr std::uint32_t no_element = 0xffffffffu, no_facet = 0xffffffffu, no_node = 0xffffffffu;

// The places of a piece at which irradiance is known: three Gauss points, through which it is taken to be
// linear (their mean integrates polynomials of degree 2), and the centre, which tells how wrong that is.
inline constexpr std::size_t places_of_piece = 4;

// A place on a side of a surface, in metres from Elements::origin_m.
struct SurfacePlace {
  glm::dvec3 position_m;
  glm::dvec3 normal; // unit length, of that side
};

struct Facet {
  std::array<glm::dvec3, 3> corners_m; // from Elements::origin_m; counter-clockwise seen from the front
  std::array<CornerWeights, 3> in_triangle;
  std::uint32_t triangle; // of the scene
  float reflectivity;     // mean
  // Of its front and its back; no_element where that side reflects nothing.
  std::array<std::uint32_t, 2> elements{no_element, no_element};
  // How much the Gauss points of these elements count at each corner.
  std::array<glm::vec3, 3> in_element{};
  bool whole = false;           // a small triangle, one of its element's group
  std::uint32_t node = no_node; // its leaf in Elements::nodes

  double area_m2() const {
    return 0.5 * glm::length(glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]));
  }
};

// How a triangle is cut up: each cut goes from the middle of an edge to the corner that faces it.
struct FacetNode {
  std::uint32_t half =
      no_node; // the first half, which keeps the edge's start, is nodes[half], the second follows
  std::uint32_t facet = no_facet; // of a leaf
  std::uint8_t edge = 0;          // from this corner to the next

  bool is_leaf() const { return half == no_node; }
};

// The side of a facet, among all.
inline std::size_t face_of(std::uint32_t facet, std::uint8_t side) { return 2 * std::size_t{facet} + side; }

// A piece of a large triangle, or a group of small ones.
struct Element {
  std::array<SurfacePlace, places_of_piece> places;
  double area_m2;
  bool is_group = false;
  // Of a group: the mean of its normals, and two directions across it, all of unit length.
  std::array<glm::dvec3, 3> axes{};
};

// The Gauss points and the centre of a triangle, as weights of its corners.
inline constexpr std::array<glm::dvec3, places_of_piece> piece_weights{
    glm::dvec3{2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0}, glm::dvec3{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0},
    glm::dvec3{1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0}, glm::dvec3{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}};

template <class Value>
Value mixed(const std::array<Value, 3> &corners, const glm::dvec3 &weights) {
  return weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
}

struct Elements {
  glm::dvec3 origin_m{0.0}; // world frame
  double size_m = 0.0;      // the largest coordinate of any corner from there
  std::vector<Facet> facets;
  std::vector<Element> elements;
  std::vector<FacetNode> nodes;
  std::vector<std::uint32_t> roots; // of each triangle of the scene; no_node without area

  // The distance from a surface at which rays start that leave it.
  double clearance_m() const { return 2e-6 * size_m; }
};

// Cuts the triangles of a scene into elements about `size_m` across. Triangles without area are left out, and
// discs. Throws Error: out_of_memory.
Elements make_elements(const Scene &scene, double size_m);

// The area of all triangles of a scene, each side that reflects.
double reflecting_area_m2(const Scene &scene);

// The places of a facet on its front (side 0) or back.
std::array<SurfacePlace, places_of_piece> places_of(const Facet &facet, std::size_t side);

// Cuts each of the facets with these indices into four, which take its place and the end of the list.
void split_facets(const Scene &scene, Elements &elements, const std::vector<std::uint32_t> &indices);
// The same of facets that are elements of their own, into four elements; returns the indices of all parts.
std::vector<std::uint32_t> split_elements(const Scene &scene, Elements &elements,
                                          const std::vector<std::uint32_t> &indices);

} // namespace pmdsim
