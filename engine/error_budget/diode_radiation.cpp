#include "engine/error_budget/diode_radiation.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <iterator>
#include <numbers>

namespace pmdsim {
namespace {

// The last of ascending numbers that is not above x, and how far x is on the way to the next one.
struct Between {
  std::size_t first, next;
  double part;
};
Between between(const std::vector<double> &ascending, double x) {
  const auto above = std::upper_bound(ascending.begin(), ascending.end(), x);
  const auto next = std::clamp<std::ptrdiff_t>(above - ascending.begin(), 1,
                                               std::max<std::ptrdiff_t>(std::ssize(ascending) - 1, 1));
  const auto at = [&](std::ptrdiff_t i) { return ascending[static_cast<std::size_t>(i)]; };
  if (ascending.size() == 1)
    return {0, 0, 0.0};
  return {static_cast<std::size_t>(next - 1), static_cast<std::size_t>(next),
          (x - at(next - 1)) / (at(next) - at(next - 1))};
}

// Between the last phi and the first one of the next turn, too.
Between between_turns(const std::vector<double> &phi_rad, double x) {
  constexpr double turn = 2.0 * std::numbers::pi;
  if (phi_rad.size() == 1)
    return {0, 0, 0.0};
  if (x >= phi_rad.front() && x < phi_rad.back())
    return between(phi_rad, x);
  const double after = x < phi_rad.front() ? x + turn - phi_rad.back() : x - phi_rad.back();
  return {phi_rad.size() - 1, 0, after / (phi_rad.front() + turn - phi_rad.back())};
}

double relative_at(const Diagram &diagram, double theta_rad, double phi_rad) {
  phi_rad += phi_rad < 0.0 ? 2.0 * std::numbers::pi : 0.0;
  if (theta_rad < diagram.theta_rad.front() || theta_rad > diagram.theta_rad.back())
    return 0.0;
  const Between theta = between(diagram.theta_rad, theta_rad), phi = between_turns(diagram.phi_rad, phi_rad);
  const auto j = [&](std::size_t i, std::size_t k) {
    return diagram.relative[i * diagram.phi_rad.size() + k];
  };
  const auto at_phi = [&](std::size_t i) { return std::lerp(j(i, phi.first), j(i, phi.next), phi.part); };
  return std::lerp(at_phi(theta.first), at_phi(theta.next), theta.part);
}

} // namespace

double radiation(const Diode &diode, const glm::dvec3 &way) {
  if (diode.pattern.kind == Pattern::Kind::isotropic)
    return 1.0;
  const double along = glm::dot(diode.axis, way);
  if (diode.pattern.kind == Pattern::Kind::cosine)
    return along > 0.0 ? std::pow(along / glm::length(way), diode.pattern.order) : 0.0;
  const glm::dvec3 across = way - along * diode.axis;
  return relative_at(
      *diode.pattern.diagram, std::atan2(glm::length(across), along),
      std::atan2(glm::dot(across, glm::cross(diode.axis, diode.across)), glm::dot(across, diode.across)));
}

} // namespace pmdsim
