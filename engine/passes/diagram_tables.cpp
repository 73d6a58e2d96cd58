#include "engine/passes/diagram_tables.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace pmdsim {
namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
// Linear interpolation on an even grid that has a node at every angle of a diagram is the diagram itself.
// Where that takes more steps than these (of theta on its own, and of theta times phi), or no grid does it,
// the finest within them stands in: beside an angle where the slope of J changes by s, it is off by s / 4 of
// a step at most. Of 180 degrees in 2^22 steps that is 1.9e-7 rad * s, in 2^11 steps 3.8e-4 rad * s.
constexpr std::uint32_t most_theta_steps = 1u << 22;
constexpr std::uint32_t most_steps = 1u << 22;
constexpr std::uint32_t most_steps_each = 1u << 11; // of theta and of phi, where neither has few

// The fewest even steps of `span_rad` from the first angle, up to `most`, that meet all the others to 1e-4 of
// a step: a bend of J is then off by 1e-4 of itself at most, and angles that a file has rounded are met too.
std::optional<std::uint32_t> even_steps(const std::vector<double> &angles_rad, double span_rad,
                                        std::uint32_t most) {
  constexpr double slack = 1e-4;
  double narrowest_rad = span_rad;
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    narrowest_rad = std::min(narrowest_rad, angles_rad[i] - angles_rad[i - 1]);
  if (!(narrowest_rad > 0.0))
    return 0;                                                                  // a single angle
  const double fewest = std::clamp(span_rad / narrowest_rad, 1.0, 1.0 + most); // more: there are none
  for (auto steps = static_cast<std::uint32_t>(fewest); steps <= most; ++steps) {
    const double per_rad = steps / span_rad;
    const bool meets_all = std::ranges::all_of(angles_rad, [&](double angle_rad) {
      const double place = (angle_rad - angles_rad.front()) * per_rad;
      return std::abs(place - std::round(place)) <= slack;
    });
    if (meets_all)
      return steps;
  }
  return std::nullopt;
}

struct Steps {
  std::uint32_t theta, phi;
};

Steps steps_of(const Diagram &diagram) {
  const double span_rad = diagram.theta_rad.back() - diagram.theta_rad.front();
  Steps steps{even_steps(diagram.theta_rad, span_rad, most_theta_steps).value_or(most_theta_steps), 0};
  if (diagram.phi_rad.size() == 1)
    return steps;
  steps.phi = even_steps(diagram.phi_rad, turn_rad, most_theta_steps).value_or(most_theta_steps);
  if (std::uint64_t{steps.theta} * steps.phi <= most_steps)
    return steps;
  if (steps.theta <= most_steps_each)
    return {steps.theta, most_steps / steps.theta};
  if (steps.phi <= most_steps_each)
    return {most_steps / steps.phi, steps.phi};
  return {most_steps_each, most_steps_each};
}

// A value between two of a diagram's angles.
struct Between {
  std::size_t lower, upper;
  double fraction;
};

double part_of(double from, double at, double to) {
  return to > from ? std::clamp((at - from) / (to - from), 0.0, 1.0) : 0.0;
}

std::size_t last_at_or_below(const std::vector<double> &angles, double angle) {
  const auto above = std::upper_bound(angles.begin() + 1, angles.end(), angle);
  return static_cast<std::size_t>(above - angles.begin()) - 1;
}

Between between_thetas(const std::vector<double> &theta_rad, double at_rad) {
  const std::size_t lower = last_at_or_below(theta_rad, at_rad);
  const std::size_t upper = std::min(lower + 1, theta_rad.size() - 1);
  return {lower, upper, part_of(theta_rad[lower], at_rad, theta_rad[upper])};
}

Between between_phis(const std::vector<double> &phi_rad, double at_rad) {
  const std::size_t lower = last_at_or_below(phi_rad, at_rad);
  const std::size_t upper = (lower + 1) % phi_rad.size();
  const double upper_rad = phi_rad[upper] + (upper == 0 ? turn_rad : 0.0);
  return {lower, upper, part_of(phi_rad[lower], at_rad, upper_rad)};
}

double value_at(const Diagram &diagram, const Between &theta, const Between &phi) {
  const auto of_theta = [&](std::size_t row) {
    const double *values = diagram.relative.data() + row * diagram.phi_rad.size();
    return std::lerp(values[phi.lower], values[phi.upper], phi.fraction);
  };
  return std::lerp(of_theta(theta.lower), of_theta(theta.upper), theta.fraction);
}

// The values for one phi, each with the next.
void append_row(const Diagram &diagram, const DiagramGrid &grid, const Between &phi,
                std::vector<glm::vec2> &values) {
  const auto value_of = [&](std::uint32_t step) {
    const double theta_rad = grid.first_theta_rad + step / grid.theta_steps_per_rad;
    return static_cast<float>(value_at(diagram, between_thetas(diagram.theta_rad, theta_rad), phi));
  };
  float value = value_of(0);
  for (std::uint32_t step = 0; step <= grid.theta_steps; ++step) {
    const float next = value_of(step + 1); // after the last the same
    values.emplace_back(value, next);
    value = next;
  }
}

} // namespace

DiagramGrid DiagramTables::grid_of(const std::shared_ptr<const Diagram> &diagram) {
  const auto [found, is_new] = grids_.try_emplace(diagram);
  DiagramGrid &grid = found->second;
  if (!is_new)
    return grid;
  const Steps steps = steps_of(*diagram);
  const double first_rad = diagram->theta_rad.front(), last_rad = diagram->theta_rad.back();
  grid.first_value = static_cast<std::uint32_t>(values_.size());
  grid.first_theta_rad = first_rad;
  grid.theta_steps_per_rad = steps.theta > 0 ? steps.theta / (last_rad - first_rad) : 1.0;
  // Straight behind the diode rounding must not lead beyond the last angle: a step more of the same.
  grid.theta_steps = steps.theta + (std::abs(last_rad - std::numbers::pi) < 1e-9 ? 1 : 0);
  grid.first_phi_rad = diagram->phi_rad.front();
  grid.phi_steps = steps.phi;
  for (std::uint32_t i = 0; i <= steps.phi; ++i) {
    const double turns = steps.phi > 0 ? static_cast<double>(i % steps.phi) / steps.phi : 0.0;
    append_row(*diagram, grid, between_phis(diagram->phi_rad, grid.first_phi_rad + turns * turn_rad),
               values_);
  }
  return grid;
}

} // namespace pmdsim
