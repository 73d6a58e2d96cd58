#include "engine/tolerance/radiation.h"

#include "engine/tolerance/lit_view.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace pmdsim {
namespace {

constexpr double angle_rounding_rad = 1e-12; // a table ends with its last angle, not a bit before

// A place between two nodes of a table's angle.
struct Place {
  std::size_t before, after;
  double fraction, per_rad; // of the way from one to the other; its slope, 0 beside a single node
};

Place place_of_theta(const std::vector<double> &nodes_rad, double theta_rad) {
  const auto last = nodes_rad.size() - 1;
  if (last == 0)
    return {0, 0, 0.0, 0.0};
  const auto beyond = std::ranges::upper_bound(nodes_rad, theta_rad);
  const auto after =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::distance(nodes_rad.begin(), beyond)), 1, last);
  const double step_rad = nodes_rad[after] - nodes_rad[after - 1];
  return {after - 1, after, std::clamp((theta_rad - nodes_rad[after - 1]) / step_rad, 0.0, 1.0),
          1.0 / step_rad};
}

// Around the axis, for any angle within a turn of 0.
Place place_of_phi(const std::vector<double> &nodes_rad, double phi_rad) {
  const auto count = nodes_rad.size();
  if (count == 1)
    return {0, 0, 0.0, 0.0};
  const double from_first_rad = phi_rad - nodes_rad.front();
  const double within_rad =
      nodes_rad.front() + from_first_rad - radians_per_turn * std::floor(from_first_rad / radians_per_turn);
  const auto beyond = std::ranges::upper_bound(nodes_rad, within_rad);
  const auto before =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(std::distance(nodes_rad.begin(), beyond), 1) - 1);
  const bool is_last = before + 1 == count;
  const double step_rad =
      (is_last ? nodes_rad.front() + radians_per_turn : nodes_rad[before + 1]) - nodes_rad[before];
  return {before, is_last ? 0 : before + 1, (within_rad - nodes_rad[before]) / step_rad, 1.0 / step_rad};
}

struct DiagramValue {
  double value, per_theta, per_phi;
};

DiagramValue value_of(const Diagram &diagram, double theta_rad, double phi_rad) {
  if (theta_rad < diagram.theta_rad.front() - angle_rounding_rad ||
      theta_rad > diagram.theta_rad.back() + angle_rounding_rad)
    return {0.0, 0.0, 0.0};
  const Place theta = place_of_theta(diagram.theta_rad, theta_rad),
              phi = place_of_phi(diagram.phi_rad, phi_rad);
  const auto node = [&](std::size_t of_theta, std::size_t of_phi) {
    return diagram.relative[of_theta * diagram.phi_rad.size() + of_phi];
  };
  const double inner = std::lerp(node(theta.before, phi.before), node(theta.before, phi.after), phi.fraction),
               outer = std::lerp(node(theta.after, phi.before), node(theta.after, phi.after), phi.fraction);
  const double around_inner = node(theta.before, phi.after) - node(theta.before, phi.before),
               around_outer = node(theta.after, phi.after) - node(theta.after, phi.before);
  return {std::lerp(inner, outer, theta.fraction), (outer - inner) * theta.per_rad,
          std::lerp(around_inner, around_outer, theta.fraction) * phi.per_rad};
}

Radiation of_diagram(const Diode &diode, const glm::dvec3 &direction) {
  const glm::dvec3 third = glm::cross(diode.axis, diode.across);
  const glm::dvec2 across(glm::dot(diode.across, direction), glm::dot(third, direction));
  const double along = glm::dot(diode.axis, direction), sine = glm::length(across);
  const DiagramValue of =
      value_of(*diode.pattern.diagram, std::atan2(sine, along), std::atan2(across.y, across.x));
  if (sine == 0.0)
    return {of.value, glm::dvec3(0.0)};
  const glm::dvec3 outwards = (across.x * diode.across + across.y * third) / sine,
                   around = (across.x * third - across.y * diode.across) / sine;
  const glm::dvec3 of_theta = along * outwards - sine * diode.axis; // unit length, where theta grows
  return {of.value, of.per_theta * of_theta + of.per_phi / sine * around};
}

} // namespace

Radiation radiation(const Diode &diode, const glm::dvec3 &direction) {
  switch (diode.pattern.kind) {
  case Pattern::Kind::cosine: {
    const double cosine = glm::dot(diode.axis, direction), order = diode.pattern.order;
    if (cosine <= 0.0)
      return {0.0, glm::dvec3(0.0)};
    const double value = std::pow(cosine, order);
    return {value, order * value / cosine * diode.axis};
  }
  case Pattern::Kind::diagram:
    return of_diagram(diode, direction);
  case Pattern::Kind::isotropic:
    break;
  }
  return {1.0, glm::dvec3(0.0)};
}

} // namespace pmdsim
