#include "engine/reference/light/radiation_laws.h"

#include "engine/reference/light/light_paths.h"
#include "engine/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pmdsim::reference {

namespace {

using Kind = Pattern::Kind;

// The rounding of an angle: a table ends with its last angle, not a bit before.
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

// At index `theta` of the diagram, the integral over phi, which is piecewise linear.
double around_axis(const Diagram &diagram, std::size_t theta) {
  const std::size_t phis = diagram.phi_rad.size();
  const double *relative = &diagram.relative[theta * phis];
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < phis; ++i)
    sum += 0.5 * (relative[i] + relative[i + 1]) * (diagram.phi_rad[i + 1] - diagram.phi_rad[i]);
  return sum + 0.5 * (relative[phis - 1] + relative[0]) *
                   (diagram.phi_rad.front() + full_turn_rad - diagram.phi_rad.back());
}

// J of a diode whose pattern is a diagram, towards `direction` (of any length but 0, in the frame of the
// diode's axis). The arctangent is exact all around, where an arccosine loses half of the digits near the
// axis.
double diagram_gain(const Diode &diode, const glm::dvec3 &direction) {
  const double theta_rad =
      std::atan2(glm::length(glm::cross(diode.axis, direction)), glm::dot(diode.axis, direction));
  const double phi_rad = std::atan2(glm::dot(glm::cross(diode.axis, diode.across), direction),
                                    glm::dot(diode.across, direction));
  return relative(*diode.pattern.diagram, theta_rad, phi_rad);
}

// Between two angles to the axis the integral over phi is linear in theta: a + slope * theta, and the
// integral of that times sin(theta) has a closed form.
double diagram_solid_angle_sr(const Diagram &diagram) {
  double sum_sr = 0.0;
  for (std::size_t i = 0; i + 1 < diagram.theta_rad.size(); ++i) {
    const double from = diagram.theta_rad[i], to = diagram.theta_rad[i + 1];
    const double at_from = around_axis(diagram, i), at_to = around_axis(diagram, i + 1);
    sum_sr += at_from * std::cos(from) - at_to * std::cos(to) +
              (at_to - at_from) / (to - from) * (std::sin(to) - std::sin(from));
  }
  return sum_sr;
}

} // namespace

double radiation(const Diode &diode, const glm::dvec3 &to_diode_m, double range_m) {
  switch (diode.pattern.kind) {
  case Kind::cosine: {
    const double cos_theta = -glm::dot(diode.axis, to_diode_m) / range_m;
    return cos_theta > 0 ? std::pow(cos_theta, diode.pattern.order) : 0.0;
  }
  case Kind::diagram:
    return diagram_gain(diode, -to_diode_m);
  case Kind::isotropic:
    break;
  }
  return 1.0;
}

double solid_angle_sr(const Pattern &pattern) {
  switch (pattern.kind) {
  case Kind::cosine:
    return full_turn_rad / (pattern.order + 1.0);
  case Kind::diagram:
    return diagram_solid_angle_sr(*pattern.diagram);
  case Kind::isotropic:
    break;
  }
  return 2.0 * full_turn_rad;
}

} // namespace pmdsim::reference
