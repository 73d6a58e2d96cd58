#include "engine/light/pattern_slope.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

// The largest tangent of the angle to the diode's axis over a box; a cone is convex, so it is at a corner.
// Infinite where the box reaches beside or behind the diode.
double largest_tangent(const Diode &diode, const VisibleBox &box) {
  double largest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 place_m((corner & 1) != 0 ? box.high_m.x : box.low_m.x,
                             (corner & 2) != 0 ? box.high_m.y : box.low_m.y,
                             (corner & 4) != 0 ? box.high_m.z : box.low_m.z);
    const glm::dvec3 way_m = place_m - diode.position_m;
    const double along_m = glm::dot(way_m, diode.axis);
    if (!(along_m > 0.0))
      return unbounded;
    largest = std::max(largest, glm::length(glm::cross(diode.axis, way_m)) / along_m);
  }
  return largest;
}

double slope_of(const Diode &diode, const std::vector<VisibleBox> &visible) {
  const Pattern &pattern = diode.pattern;
  if (pattern.kind == Pattern::Kind::isotropic)
    return 0.0;
  if (pattern.kind == Pattern::Kind::diagram) // a table's slope jumps
    return unbounded;
  double tangent = 0.0;
  for (const VisibleBox &box : visible)
    tangent = std::max(tangent, largest_tangent(diode, box));
  if (tangent == unbounded) // also of order 0, which ends as an edge
    return unbounded;
  // d ln cos^n = -n tan, and the second derivative is -n / cos^2.
  return std::max(pattern.order * tangent, std::sqrt(pattern.order * (1.0 + tangent * tangent)));
}

} // namespace

double pattern_slope(const std::vector<CameraIlluminator> &illuminators,
                     const std::vector<VisibleBox> &visible) {
  double slope = 0.0;
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes)
      if (slope < unbounded)
        slope = std::max(slope, slope_of(diode, visible));
  return slope;
}

} // namespace pmdsim
