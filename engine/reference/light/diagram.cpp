#include "engine/reference/light/diagram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace pmdsim::reference {

namespace {

// What rounding may make of an angle: a table ends with its last angle, not a bit before.
constexpr double angle_rounding_rad = 1e-12;

// Between two nodes of an axis: (1 - fraction) of the first and `fraction` of the second.
struct Between {
  std::size_t first, second;
  double fraction;
};

// Where `angle_rad` lies among ascending nodes of which the first is not beyond it and the last not before.
Between between_nodes(const std::vector<double> &nodes_rad, double angle_rad) {
  const auto beyond = std::upper_bound(nodes_rad.begin(), nodes_rad.end(), angle_rad);
  if (beyond == nodes_rad.end())
    return {nodes_rad.size() - 1, nodes_rad.size() - 1, 0.0};
  const auto second = static_cast<std::size_t>(std::distance(nodes_rad.begin(), beyond));
  const double first_rad = nodes_rad[second - 1];
  return {second - 1, second, (angle_rad - first_rad) / (nodes_rad[second] - first_rad)};
}

// The same around a circle, for any angle within a turn of 0.
Between between_nodes_around(const std::vector<double> &nodes_rad, double angle_rad) {
  double turned_rad = angle_rad < 0 ? angle_rad + full_turn_rad : angle_rad;
  if (turned_rad < nodes_rad.front())
    turned_rad += full_turn_rad;
  if (turned_rad < nodes_rad.back())
    return between_nodes(nodes_rad, turned_rad);
  const double gap_rad = nodes_rad.front() + full_turn_rad - nodes_rad.back();
  return {nodes_rad.size() - 1, 0, (turned_rad - nodes_rad.back()) / gap_rad};
}

double relative(const Diagram &diagram, double theta_rad, double phi_rad) {
  const auto [first_rad, last_rad] = std::pair(diagram.theta_rad.front(), diagram.theta_rad.back());
  if (theta_rad < first_rad - angle_rounding_rad || theta_rad > last_rad + angle_rounding_rad)
    return 0.0;
  const Between theta = between_nodes(diagram.theta_rad, std::clamp(theta_rad, first_rad, last_rad));
  const Between phi = between_nodes_around(diagram.phi_rad, phi_rad);
  const auto at_theta = [&](std::size_t node) {
    const double *around = &diagram.relative[node * diagram.phi_rad.size()];
    return std::lerp(around[phi.first], around[phi.second], phi.fraction);
  };
  return std::lerp(at_theta(theta.first), at_theta(theta.second), theta.fraction);
}

} // namespace

// The arctangent is exact all around, where an arccosine loses half of the digits near the axis.
double diagram_gain(const Diode &diode, const glm::dvec3 &direction) {
  const double theta_rad =
      std::atan2(glm::length(glm::cross(diode.axis, direction)), glm::dot(diode.axis, direction));
  const double phi_rad = std::atan2(glm::dot(glm::cross(diode.axis, diode.across), direction),
                                    glm::dot(diode.across, direction));
  return relative(*diode.pattern.diagram, theta_rad, phi_rad);
}

} // namespace pmdsim::reference
