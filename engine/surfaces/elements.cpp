#include "engine/surfaces/elements.h"

#include "engine/surfaces/surface_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace pmdsim {
namespace {

using Corners = std::array<glm::dvec3, 3>;

glm::dvec3 front_of(const Corners &corners_m) {
  return glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]);
}

double area_of(const Corners &corners_m) { return 0.5 * glm::length(front_of(corners_m)); }

std::array<SurfacePlace, places_of_piece> places_on(const Corners &corners_m, std::size_t side) {
  const glm::dvec3 normal = (side == 0 ? 1.0 : -1.0) * glm::normalize(front_of(corners_m));
  std::array<SurfacePlace, places_of_piece> places;
  for (std::size_t i = 0; i < places_of_piece; ++i)
    places[i] = {mixed(corners_m, piece_weights[i]), normal};
  return places;
}

// Of a linear function that is known at the Gauss points: how much each counts at a place.
glm::vec3 gauss_weights(const glm::dvec3 &in_element) { return glm::vec3(2.0 * in_element - 1.0 / 3.0); }

// A part of a triangle, and how its corners lie in it.
struct Piece {
  Corners corners_m;
  std::array<CornerWeights, 3> weights;
};

std::size_t longest_edge(const Corners &corners_m) {
  std::size_t longest = 0;
  double length_m = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const double edge_m = glm::distance(corners_m[i], corners_m[(i + 1) % 3]); edge_m > length_m)
      std::tie(longest, length_m) = std::tie(i, edge_m);
  return longest;
}

// The halves of a piece, cut from the middle of an edge. That of the longest keeps them from becoming
// slivers.
std::array<Piece, 2> halves_of(const Piece &piece, std::size_t edge) {
  const std::size_t a = edge, b = (a + 1) % 3;
  std::array<Piece, 2> halves{piece, piece};
  for (Piece &half : halves) {
    const std::size_t moved = &half == &halves.front() ? b : a;
    half.corners_m[moved] = 0.5 * (piece.corners_m[a] + piece.corners_m[b]);
    half.weights[moved] = 0.5 * (piece.weights[a] + piece.weights[b]);
  }
  return halves;
}

// Makes a leaf the parent of two new ones; returns the first.
std::uint32_t add_halves(Elements &elements, std::uint32_t node, std::size_t edge) {
  const auto half = static_cast<std::uint32_t>(elements.nodes.size());
  elements.nodes[node] = {half, no_facet, static_cast<std::uint8_t>(edge)};
  elements.nodes.resize(elements.nodes.size() + 2);
  return half;
}

void add_leaf(Elements &elements, const Facet &facet, std::uint32_t node) {
  elements.nodes[node].facet = static_cast<std::uint32_t>(elements.facets.size());
  elements.facets.push_back(facet);
  elements.facets.back().node = node;
}

std::uint32_t add_element(Elements &elements) {
  elements.elements.emplace_back();
  return static_cast<std::uint32_t>(elements.elements.size() - 1);
}

// Makes the elements of a facet's sides what the facet is.
void make_own_elements(Elements &elements, Facet &facet) {
  for (std::size_t side = 0; side < 2; ++side)
    if (facet.elements[side] != no_element)
      elements.elements[facet.elements[side]] = {places_on(facet.corners_m, side), facet.area_m2()};
  for (glm::length_t i = 0; i < 3; ++i) {
    glm::dvec3 corner(0.0);
    corner[i] = 1.0;
    facet.in_element[static_cast<std::size_t>(i)] = gauss_weights(corner);
  }
}

// Cuts a facet in two: the first half takes its place, the second the end of the list.
std::array<std::uint32_t, 2> halve_facet(const Scene &scene, Elements &elements, std::uint32_t index) {
  const Facet whole = elements.facets[index];
  const std::size_t a = longest_edge(whole.corners_m), b = (a + 1) % 3;
  const std::uint32_t half = add_halves(elements, whole.node, a);
  const std::array<std::uint32_t, 2> indices{index, static_cast<std::uint32_t>(elements.facets.size())};
  elements.facets.push_back(whole);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t moved = i == 0 ? b : a;
    Facet &facet = elements.facets[indices[i]];
    facet.corners_m[moved] = 0.5 * (whole.corners_m[a] + whole.corners_m[b]);
    facet.in_triangle[moved] = 0.5 * (whole.in_triangle[a] + whole.in_triangle[b]);
    facet.in_element[moved] = 0.5f * (whole.in_element[a] + whole.in_element[b]);
    facet.reflectivity = static_cast<float>(mean_reflectivity(scene, facet.triangle, facet.in_triangle));
    facet.node = half + static_cast<std::uint32_t>(i);
    elements.nodes[facet.node].facet = indices[i];
  }
  return indices;
}

// Groups of small triangles: those whose centres lie in one cube and whose normals in one of 150 bins.
using GroupKey = std::tuple<std::int64_t, std::int64_t, std::int64_t, int, bool>;

int normal_bin(const glm::dvec3 &normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const double along = normal[axis];
  const auto part = [&](int other) {
    return std::clamp(static_cast<int>(2.5 * (normal[other] / std::abs(along) + 1.0)), 0, 4);
  };
  return ((axis * 2 + (along < 0.0 ? 1 : 0)) * 5 + part((axis + 1) % 3)) * 5 + part((axis + 2) % 3);
}

class Builder {
public:
  Builder(const Scene &scene, double size_m) : scene_(scene), size_m_(size_m) {}

  Elements build() {
    find_origin();
    for (std::uint32_t id = 0; id < scene_.triangles.size(); ++id) {
      const Corners corners_m = corners_of(id);
      const double area_m2 = area_of(corners_m);
      made_.roots.push_back(no_node);
      if (!(area_m2 > 0.0))
        continue;
      made_.roots.back() = static_cast<std::uint32_t>(made_.nodes.size());
      made_.nodes.emplace_back();
      if (area_m2 > 0.25 * size_m_ * size_m_)
        cut({corners_m, {CornerWeights{1, 0, 0}, CornerWeights{0, 1, 0}, CornerWeights{0, 0, 1}}}, id,
            made_.roots.back());
      else
        add_small(corners_m, id);
    }
    finish_groups();
    return std::move(made_);
  }

private:
  Corners corners_of(std::uint32_t id) const {
    Corners corners_m;
    for (std::size_t i = 0; i < 3; ++i)
      corners_m[i] = scene_.positions_m[scene_.triangles[id].vertices[i]] - made_.origin_m;
    return corners_m;
  }
  bool is_double_sided(std::uint32_t id) const {
    return scene_.surfaces[scene_.triangles[id].surface].double_sided;
  }

  void find_origin() {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Triangle &triangle : scene_.triangles)
      for (const std::uint32_t vertex : triangle.vertices) {
        low = glm::min(low, scene_.positions_m[vertex]);
        high = glm::max(high, scene_.positions_m[vertex]);
      }
    if (scene_.triangles.empty())
      return;
    made_.origin_m = 0.5 * (low + high);
    const glm::dvec3 half = 0.5 * (high - low);
    made_.size_m = std::max({half.x, half.y, half.z});
  }

  void cut(const Piece &piece, std::uint32_t id, std::uint32_t node) {
    if (area_of(piece.corners_m) > 0.5 * size_m_ * size_m_) {
      const std::size_t edge = longest_edge(piece.corners_m);
      std::uint32_t half = add_halves(made_, node, edge);
      for (const Piece &part : halves_of(piece, edge))
        cut(part, id, half++);
      return;
    }
    add_leaf(made_, facet_of(piece, id), node);
    Facet &facet = made_.facets.back();
    for (std::size_t side = 0; side < (is_double_sided(id) ? 2u : 1u); ++side)
      facet.elements[side] = add_element(made_);
    make_own_elements(made_, facet);
  }

  Facet facet_of(const Piece &piece, std::uint32_t id) const {
    return {.corners_m = piece.corners_m,
            .in_triangle = piece.weights,
            .triangle = id,
            .reflectivity = static_cast<float>(mean_reflectivity(scene_, id, piece.weights))};
  }

  void add_small(const Corners &corners_m, std::uint32_t id) {
    Facet facet =
        facet_of({corners_m, {CornerWeights{1, 0, 0}, CornerWeights{0, 1, 0}, CornerWeights{0, 0, 1}}}, id);
    facet.whole = true;
    facet.in_element.fill(glm::vec3(1.0f / 3.0f));
    const glm::dvec3 cube = glm::floor(mixed(corners_m, piece_weights[3]) / size_m_);
    const GroupKey key{static_cast<std::int64_t>(cube.x), static_cast<std::int64_t>(cube.y),
                       static_cast<std::int64_t>(cube.z), normal_bin(glm::normalize(front_of(corners_m))),
                       is_double_sided(id)};
    groups_[key].push_back(static_cast<std::uint32_t>(made_.facets.size()));
    add_leaf(made_, facet, made_.roots.back());
  }

  // The members of a group at which equal parts of its area end, so that large ones stand for more.
  std::array<std::uint32_t, places_of_piece> spokesmen(const std::vector<std::uint32_t> &group,
                                                       double area_m2) const {
    std::array<std::uint32_t, places_of_piece> chosen;
    std::size_t next = 0;
    double sum_m2 = 0.0;
    for (const std::uint32_t member : group) {
      sum_m2 += made_.facets[member].area_m2();
      while (next < chosen.size() && sum_m2 >= (static_cast<double>(next) + 0.5) / chosen.size() * area_m2)
        chosen[next++] = member;
    }
    while (next < chosen.size())
      chosen[next++] = group.back();
    return chosen;
  }

  std::array<glm::dvec3, 3> axes_of(const std::vector<std::uint32_t> &group, std::size_t side) const {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t member : group)
      sum += (side == 0 ? 1.0 : -1.0) * front_of(made_.facets[member].corners_m);
    const SurfaceFrame frame({glm::dvec3(0.0), glm::normalize(sum)}, 0.0);
    return {frame.z, frame.x, frame.y};
  }

  void finish_groups() {
    for (const auto &[key, group] : groups_) {
      double area_m2 = 0.0;
      for (const std::uint32_t member : group)
        area_m2 += made_.facets[member].area_m2();
      const auto chosen = spokesmen(group, area_m2);
      for (std::size_t side = 0; side < (std::get<bool>(key) ? 2u : 1u); ++side) {
        Element element{{}, area_m2, true, axes_of(group, side)};
        for (std::size_t i = 0; i < places_of_piece; ++i)
          element.places[i] = places_on(made_.facets[chosen[i]].corners_m, side)[3];
        for (const std::uint32_t member : group)
          made_.facets[member].elements[side] = static_cast<std::uint32_t>(made_.elements.size());
        made_.elements.push_back(element);
      }
    }
  }

  const Scene &scene_;
  double size_m_;
  Elements made_;
  std::map<GroupKey, std::vector<std::uint32_t>> groups_;
};

} // namespace

Elements make_elements(const Scene &scene, double size_m) { return Builder(scene, size_m).build(); }

double reflecting_area_m2(const Scene &scene) {
  double area_m2 = 0.0;
  for (const Triangle &triangle : scene.triangles) {
    const auto corner = [&](std::size_t i) { return scene.positions_m[triangle.vertices[i]]; };
    area_m2 += area_of({corner(0), corner(1), corner(2)}) *
               (scene.surfaces[triangle.surface].double_sided ? 2.0 : 1.0);
  }
  return area_m2;
}

std::array<SurfacePlace, places_of_piece> places_of(const Facet &facet, std::size_t side) {
  return places_on(facet.corners_m, side);
}

void split_facets(const Scene &scene, Elements &elements, const std::vector<std::uint32_t> &indices) {
  for (const std::uint32_t index : indices)
    for (const std::uint32_t half : halve_facet(scene, elements, index))
      halve_facet(scene, elements, half);
}

std::vector<std::uint32_t> split_elements(const Scene &scene, Elements &elements,
                                          const std::vector<std::uint32_t> &indices) {
  std::vector<std::uint32_t> parts;
  for (const std::uint32_t index : indices)
    for (const std::uint32_t half : halve_facet(scene, elements, index))
      for (const std::uint32_t part : halve_facet(scene, elements, half)) {
        Facet &facet = elements.facets[part];
        for (std::uint32_t &element : facet.elements)
          if (part != index && element != no_element)
            element = add_element(elements);
        make_own_elements(elements, facet);
        parts.push_back(part);
      }
  return parts;
}

} // namespace pmdsim
