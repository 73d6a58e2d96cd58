#include "engine/reference/view/distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pmdsim::reference {

namespace {

// Rays so close to 90 degrees are beyond what slopes can say.
constexpr double largest_slope = 1e8;

glm::dvec2 slopes_of(const glm::dvec3 &place) { return glm::dvec2(place) / place.z; }

// `length` long in the direction of `along`; zero has no direction.
glm::dvec2 of_length(double length, const glm::dvec2 &along) {
  const double present = glm::length(along);
  return present > 0 ? along * (length / present) : glm::dvec2(0.0);
}

} // namespace

std::optional<glm::dvec2> PinholeLens::slopes(const glm::dvec3 &ray) const {
  return ray.z > 0 ? std::optional(slopes_of(ray)) : std::nullopt;
}

BrownConradyLens::BrownConradyLens(const BrownConrady &distortion)
    : distortion_(distortion), radial_({distortion.k1, distortion.k2, distortion.k3}, largest_slope) {}

std::optional<glm::dvec2> BrownConradyLens::slopes(const glm::dvec3 &ray) const {
  return ray.z > 0 ? std::optional(distorted(slopes_of(ray))) : std::nullopt;
}

std::optional<glm::dvec3> BrownConradyLens::ray(const glm::dvec3 &place_m) const {
  const auto slopes = undistorted(slopes_of(place_m));
  return slopes ? std::optional(glm::dvec3(*slopes, 1.0)) : std::nullopt;
}

glm::dvec2 BrownConradyLens::distorted(const glm::dvec2 &slopes) const {
  const auto &[k1, k2, p1, p2, k3] = distortion_;
  const auto [x, y] = std::pair(slopes.x, slopes.y);
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

glm::dmat2 BrownConradyLens::jacobian(const glm::dvec2 &slopes) const {
  const auto &[k1, k2, p1, p2, k3] = distortion_;
  const auto [x, y] = std::pair(slopes.x, slopes.y);
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double radial_slope = k1 + r2 * (2 * k2 + r2 * 3 * k3); // d radial / d r2
  const double xx = radial + 2 * x * x * radial_slope + 2 * p1 * y + 6 * p2 * x;
  const double xy = 2 * x * y * radial_slope + 2 * p1 * x + 2 * p2 * y;
  const double yy = radial + 2 * y * y * radial_slope + 6 * p1 * y + 2 * p2 * x;
  return {xx, xy, xy, yy};
}

// The Jacobian is positive definite: the branch that begins at the optical axis has not folded here.
bool BrownConradyLens::rises(const glm::dvec2 &slopes) const {
  const glm::dmat2 j = jacobian(slopes);
  return j[0][0] > 0 && glm::determinant(j) > 0;
}

// Nor on the way here, behind which another branch could rise again.
bool BrownConradyLens::rises_from_axis(const glm::dvec2 &slopes) const {
  constexpr int places = 16;
  for (int i = 1; i <= places; ++i)
    if (!rises(slopes * (static_cast<double>(i) / places)))
      return false;
  return true;
}

// One step of Newton's method, shortened until it comes nearer to what is wanted and stays on the branch;
// nothing where no step does.
std::optional<glm::dvec2> BrownConradyLens::nearer(const glm::dvec2 &slopes, const glm::dvec2 &wanted) const {
  const glm::dvec2 missing = wanted - distorted(slopes);
  const glm::dvec2 step = glm::inverse(jacobian(slopes)) * missing;
  constexpr int most_halvings = 10;
  for (int halvings = 0; halvings < most_halvings; ++halvings) {
    const glm::dvec2 there = slopes + std::ldexp(1.0, -halvings) * step;
    if (rises(there) && glm::length(wanted - distorted(there)) < glm::length(missing))
      return there;
  }
  return std::nullopt;
}

std::optional<glm::dvec2> BrownConradyLens::undistorted(const glm::dvec2 &wanted) const {
  const double radius = glm::length(wanted);
  if (distortion_.p1 == 0 && distortion_.p2 == 0) {
    const auto undistorted_radius = radial_.inverse(radius);
    return undistorted_radius ? std::optional(of_length(*undistorted_radius, wanted)) : std::nullopt;
  }
  // The tangential terms are small against the radial ones: they move the solution, and the fold, a little.
  const double start_radius = *radial_.inverse(std::min(radius, 0.999 * radial_.value(radial_.end())));
  glm::dvec2 slopes = of_length(start_radius, wanted);
  constexpr int most_steps = 50;
  for (int i = 0; i < most_steps; ++i) {
    const auto next = nearer(slopes, wanted);
    if (!next)
      break;
    slopes = *next;
  }
  constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();
  const bool found = glm::length(wanted - distorted(slopes)) <= rounding * radius;
  return found && rises_from_axis(slopes) ? std::optional(slopes) : std::nullopt;
}

FisheyeLens::FisheyeLens(const Fisheye &distortion)
    : radial_({distortion.k1, distortion.k2, distortion.k3, distortion.k4}, std::numbers::pi) {}

std::optional<glm::dvec2> FisheyeLens::slopes(const glm::dvec3 &ray) const {
  const glm::dvec2 across(ray);
  return of_length(radial_.value(std::atan2(glm::length(across), ray.z)), across);
}

std::optional<glm::dvec3> FisheyeLens::ray(const glm::dvec3 &place_m) const {
  const glm::dvec2 slopes = slopes_of(place_m);
  const auto angle_rad = radial_.inverse(glm::length(slopes));
  if (!angle_rad)
    return std::nullopt;
  return glm::dvec3(of_length(std::sin(*angle_rad), slopes), std::cos(*angle_rad));
}

} // namespace pmdsim::reference
