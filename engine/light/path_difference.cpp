#include "engine/light/path_difference.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

// How far a place is from each axis.
glm::dvec3 across(const glm::dvec3 &p) {
  return {std::hypot(p.y, p.z), std::hypot(p.x, p.z), std::hypot(p.x, p.y)};
}

// How far diodes reach from a reference point, along each axis and across it.
struct Reach {
  glm::dvec3 along_m{0.0};
  glm::dvec3 across_m{0.0};
};

// A bound of |P . I| for points whose coordinates are at most `p` and diodes I within `reach`: Cauchy and
// Schwarz in one plane of coordinates and its normal, the best of three. (In the plane of a ring it is
// exact.)
double largest_product(const glm::dvec3 &p, const Reach &reach) {
  const glm::dvec3 bounds = p * reach.along_m + across(p) * reach.across_m;
  return std::min({bounds.x, bounds.y, bounds.z});
}

// A bound of |I|^2 - 2 P.I from below, likewise: of the part along an axis and the part across it, each at
// its worst.
double least_difference_m2(const glm::dvec3 &p, const Reach &reach) {
  const auto part = [](double place_m, double reach_m) { // i^2 - 2 p i for i up to reach_m
    const double worst_m = std::min(place_m, reach_m);
    return worst_m * (worst_m - 2.0 * place_m);
  };
  const glm::dvec3 across_m = across(p);
  double best = -std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
    best = std::max(best, part(p[axis], reach.along_m[axis]) + part(across_m[axis], reach.across_m[axis]));
  return best;
}

// |r - rho| = |q| / (r + rho) with q = r^2 - rho^2 = |I|^2 - 2 P.I, which is small where the diodes stand
// across the view (`product_m2` bounds |P.I|); it is never more than |I|.
double path_difference_at_most_m(double radius_m, double product_m2, double rho_m) {
  const double q_m2 = radius_m * radius_m + 2.0 * product_m2;
  const double sum_m = rho_m + std::max(0.0, rho_m - radius_m);
  return sum_m > 0.0 ? std::min(radius_m, q_m2 / sum_m) : radius_m;
}

// q / rho^2; r is between rho - |I| and rho + |I|.
void widen_stretch(double radius_m, double least_m2, double product_m2, double rho_m,
                   PathDifference &result) {
  const double rho2 = rho_m * rho_m, t = radius_m / rho_m;
  if (!(t < 1.0)) {
    result.most_stretch = std::numeric_limits<double>::infinity();
    return;
  }
  result.least_stretch = std::min(result.least_stretch, std::max(least_m2 / rho2, -t * (2.0 - t)));
  result.most_stretch =
      std::max(result.most_stretch, std::min((radius_m * radius_m + 2.0 * product_m2) / rho2, t * (2.0 + t)));
}

double nearest_m(const VisibleBox &box, const glm::dvec3 &from_m) {
  return glm::distance(from_m, glm::clamp(from_m, box.low_m, box.high_m));
}

glm::dvec3 farthest_along_axes_m(const VisibleBox &box, const glm::dvec3 &from_m) {
  return glm::max(glm::abs(box.low_m - from_m), glm::abs(box.high_m - from_m));
}

// A bound takes the nearest and the farthest place of a box for one, so that one long box, of a floor, would
// decide for all. Boxes that are long for their distance are cut into cells.
constexpr double longest_cell = 0.15; // over its distance
constexpr int most_cells = 8;         // along an axis

template <class Look>
void for_each_cell(const VisibleBox &box, const glm::dvec3 &from_m, Look look) {
  const glm::dvec3 size_m = box.high_m - box.low_m;
  const double longest_m = std::max(longest_cell * nearest_m(box, from_m), 1e-9);
  const glm::ivec3 cells(glm::clamp(glm::ceil(size_m / longest_m), 1.0, static_cast<double>(most_cells)));
  const auto corner = [&](int x, int y, int z) {
    return glm::mix(box.low_m, box.high_m, glm::dvec3(x, y, z) / glm::dvec3(cells));
  };
  for (int x = 0; x < cells.x; ++x)
    for (int y = 0; y < cells.y; ++y)
      for (int z = 0; z < cells.z; ++z)
        look(VisibleBox{corner(x, y, z), corner(x + 1, y + 1, z + 1)});
}

} // namespace

PathDifference path_difference_of(const glm::dvec3 &reference_m, std::span<const glm::dvec3> diodes_m,
                                  const std::vector<VisibleBox> &visible) {
  PathDifference result;
  Reach reach;
  for (const glm::dvec3 &diode_m : diodes_m) {
    result.radius_m = std::max(result.radius_m, glm::distance(reference_m, diode_m));
    reach.along_m = glm::max(reach.along_m, glm::abs(diode_m - reference_m));
    reach.across_m = glm::max(reach.across_m, across(diode_m - reference_m));
  }
  for (const VisibleBox &seen : visible)
    for_each_cell(seen, reference_m, [&](const VisibleBox &cell) {
      const double rho_m = nearest_m(cell, reference_m);
      const glm::dvec3 farthest_m = farthest_along_axes_m(cell, reference_m);
      const double product_m2 = largest_product(farthest_m, reach);
      result.range_m = std::min(result.range_m, rho_m);
      result.farthest_m = std::max(result.farthest_m, glm::length(farthest_m));
      result.path_difference_m =
          std::max(result.path_difference_m, path_difference_at_most_m(result.radius_m, product_m2, rho_m));
      widen_stretch(result.radius_m, least_difference_m2(farthest_m, reach), product_m2, rho_m, result);
    });
  return result;
}

} // namespace pmdsim
