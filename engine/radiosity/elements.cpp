#include "engine/radiosity/elements.h"

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

// The halves of a piece, cut from the middle of its longest edge, which keeps them from becoming slivers.
std::array<Piece, 2> halves_of(const Piece &piece) {
  const std::size_t a = longest_edge(piece.corners_m), b = (a + 1) % 3;
  std::array<Piece, 2> halves{piece, piece};
  for (Piece &half : halves) {
    const std::size_t moved = &half == &halves.front() ? b : a;
    half.corners_m[moved] = 0.5 * (piece.corners_m[a] + piece.corners_m[b]);
    half.weights[moved] = 0.5 * (piece.weights[a] + piece.weights[b]);
  }
  return halves;
}

// Groups of small triangles: those whose centres lie in one cube and whose normals in one of 54 bins.
using GroupKey = std::tuple<std::int64_t, std::int64_t, std::int64_t, int, bool>;

int normal_bin(const glm::dvec3 &normal) {
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const double along = normal[axis];
  const auto part = [&](int other) {
    return std::clamp(static_cast<int>(1.5 * (normal[other] / std::abs(along) + 1.0)), 0, 2);
  };
  return ((axis * 2 + (along < 0.0 ? 1 : 0)) * 3 + part((axis + 1) % 3)) * 3 + part((axis + 2) % 3);
}

class Builder {
public:
  Builder(const Scene &scene, double size_m) : scene_(scene), size_m_(size_m) {}

  Elements build() {
    find_origin();
    for (std::uint32_t id = 0; id < scene_.triangles.size(); ++id) {
      const Corners corners_m = corners_of(id);
      const double area_m2 = area_of(corners_m);
      if (!(area_m2 > 0.0))
        continue;
      if (area_m2 > 0.25 * size_m_ * size_m_)
        cut({corners_m, {CornerWeights{1, 0, 0}, CornerWeights{0, 1, 0}, CornerWeights{0, 0, 1}}}, id);
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

  void cut(const Piece &piece, std::uint32_t id) {
    if (area_of(piece.corners_m) > 0.5 * size_m_ * size_m_) {
      for (const Piece &half : halves_of(piece))
        cut(half, id);
      return;
    }
    Facet facet = facet_of(piece, id);
    for (std::size_t side = 0; side < (is_double_sided(id) ? 2u : 1u); ++side) {
      facet.elements[side] = static_cast<std::uint32_t>(made_.elements.size());
      made_.elements.push_back({places_on(piece.corners_m, side), facet.area_m2()});
    }
    for (glm::length_t i = 0; i < 3; ++i) {
      glm::dvec3 corner(0.0);
      corner[i] = 1.0;
      facet.in_element[static_cast<std::size_t>(i)] = gauss_weights(corner);
    }
    made_.facets.push_back(facet);
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
    made_.facets.push_back(facet);
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

  void finish_groups() {
    for (const auto &[key, group] : groups_) {
      double area_m2 = 0.0;
      for (const std::uint32_t member : group)
        area_m2 += made_.facets[member].area_m2();
      const auto chosen = spokesmen(group, area_m2);
      for (std::size_t side = 0; side < (std::get<bool>(key) ? 2u : 1u); ++side) {
        Element element{{}, area_m2};
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
  constexpr std::array<std::array<glm::dvec3, 3>, 4> parts{{
      {{{1.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}}},
      {{{0.5, 0.5, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.5, 0.5}}},
      {{{0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}, {0.0, 0.0, 1.0}}},
      {{{0.5, 0.5, 0.0}, {0.0, 0.5, 0.5}, {0.5, 0.0, 0.5}}},
  }};
  for (const std::uint32_t index : indices) {
    const Facet whole = elements.facets[index];
    for (const auto &part : parts) {
      Facet facet = whole;
      for (std::size_t i = 0; i < 3; ++i) {
        facet.corners_m[i] = mixed(whole.corners_m, part[i]);
        facet.in_triangle[i] = mixed(whole.in_triangle, part[i]);
        facet.in_element[i] = glm::vec3(0.0f);
        for (glm::length_t k = 0; k < 3; ++k)
          facet.in_element[i] +=
              static_cast<float>(part[i][k]) * whole.in_element[static_cast<std::size_t>(k)];
      }
      facet.reflectivity = static_cast<float>(mean_reflectivity(scene, facet.triangle, facet.in_triangle));
      if (&part == &parts.front())
        elements.facets[index] = facet;
      else
        elements.facets.push_back(facet);
    }
  }
}

} // namespace pmdsim
