#include "engine/light/diagram_tables.h"

#include "engine/light/rounding_units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace pmdsim {
namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
// Linear interpolation on an even grid that has a node at every angle of a diagram is the diagram itself.
// Where no grid within these steps does it, the finest stands in: beside an angle where the slope of J
// changes by s, it is off by s / 4 of a step at most. For 180 degrees that is 1.9e-7 rad * s.
constexpr std::uint32_t most_steps = 1u << 22;

// The fewest even steps of `span_rad` from the first angle, up to most_steps, that meet all the others to
// 1e-4 of a step: a bend of J is then off by 1e-4 of itself at most, and angles that a file has rounded are
// met too.
std::optional<std::uint32_t> even_steps(const std::vector<double> &angles_rad, double span_rad) {
  constexpr double slack = 1e-4;
  double narrowest_rad = span_rad;
  for (std::size_t i = 1; i < angles_rad.size(); ++i)
    narrowest_rad = std::min(narrowest_rad, angles_rad[i] - angles_rad[i - 1]);
  if (!(narrowest_rad > 0.0))
    return 0;                                                                        // a single angle
  const double fewest = std::clamp(span_rad / narrowest_rad, 1.0, 1.0 + most_steps); // more: there are none
  for (auto steps = static_cast<std::uint32_t>(fewest); steps <= most_steps; ++steps) {
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

// How far along `angles` an angle is: 1.5 is half way between the second and the third.
double place_among(const std::vector<double> &angles, double angle) {
  const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
  if (above == angles.begin())
    return 0.0;
  if (above == angles.end())
    return static_cast<double>(angles.size() - 1);
  const double lower = *(above - 1);
  return static_cast<double>(above - angles.begin() - 1) + (angle - lower) / (*above - lower);
}

// As place_among; behind the last phi comes the first one of the next turn.
double place_around(const std::vector<double> &phi_rad, double angle_rad) {
  if (phi_rad.size() == 1)
    return 0.0;
  const double from_first_rad = angle_rad < phi_rad.front() ? angle_rad + turn_rad : angle_rad,
               behind_rad = from_first_rad - phi_rad.back();
  return behind_rad < 0.0 ? place_among(phi_rad, from_first_rad)
                          : static_cast<double>(phi_rad.size() - 1) +
                                behind_rad / (phi_rad.front() + turn_rad - phi_rad.back());
}

// The largest error of the even grid that holds `value_of` the place among `angles` at each of its steps: it
// is found at one of the angles, where the value bends.
template <class ValueOf>
double grid_error(const std::vector<double> &angles, double steps_per_rad, ValueOf value_of) {
  const auto value_at_step = [&](double step) {
    return value_of(place_among(angles, angles.front() + step / steps_per_rad));
  };
  double largest = 0.0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double at = (angles[i] - angles.front()) * steps_per_rad, lower = std::floor(at);
    const double value = std::lerp(value_at_step(lower), value_at_step(lower + 1.0), at - lower);
    largest = std::max(largest, std::abs(value - value_of(static_cast<double>(i))));
  }
  return largest;
}

double value_at(const std::vector<double> &values, double place) {
  const auto lower = static_cast<std::size_t>(place);
  const std::size_t upper = std::min(lower + 1, values.size() - 1);
  return std::lerp(values[lower], values[upper], place - static_cast<double>(lower));
}

// The largest changes of J from an angle to the next, in theta and in phi.
glm::dvec2 largest_steps(const Diagram &diagram) {
  const std::size_t columns = diagram.phi_rad.size(), rows = diagram.theta_rad.size();
  const auto value = [&](std::size_t t, std::size_t p) {
    return diagram.relative[t * columns + p % columns];
  };
  glm::dvec2 largest(0.0);
  for (std::size_t t = 0; t < rows; ++t)
    for (std::size_t p = 0; p < columns; ++p) {
      const glm::dvec2 next(value(std::min(t + 1, rows - 1), p), value(t, p + 1));
      largest = glm::max(largest, glm::abs(next - value(t, p)));
    }
  return largest;
}

// The angles of phi, and the first again.
std::vector<double> around(const Diagram &diagram) {
  std::vector<double> phis = diagram.phi_rad;
  phis.push_back(phis.front() + turn_rad);
  return phis;
}

// The largest change of J where theta is off by error_of(theta), which never falls.
template <class ErrorOf>
double largest_change(const Diagram &diagram, const ErrorOf &error_of) {
  const std::size_t columns = diagram.phi_rad.size();
  double largest = 0.0;
  for (std::size_t t = 1; t < diagram.theta_rad.size(); ++t)
    for (std::size_t p = 0; p < columns; ++p) {
      const double change = diagram.relative[t * columns + p] - diagram.relative[(t - 1) * columns + p];
      const double slope = std::abs(change) / (diagram.theta_rad[t] - diagram.theta_rad[t - 1]);
      largest = std::max(largest, slope * error_of(diagram.theta_rad[t]));
    }
  return largest;
}

// Over sin theta.
double slope_in_phi(const Diagram &diagram) {
  const std::size_t columns = diagram.phi_rad.size();
  double slope = 0.0;
  for (std::size_t t = 0; t < diagram.theta_rad.size(); ++t)
    for (std::size_t p = 0; p < columns; ++p) {
      const std::size_t next = (p + 1) % columns;
      const double change = diagram.relative[t * columns + next] - diagram.relative[t * columns + p];
      double step_rad = diagram.phi_rad[next] - diagram.phi_rad[p];
      if (next == 0)
        step_rad += 2.0 * std::numbers::pi;
      if (change != 0.0) // twice, as between the axis and the first row the ratio may be larger
        slope = std::max(slope, 2.0 * std::abs(change) / (step_rad * std::sin(diagram.theta_rad[t])));
    }
  return std::isfinite(slope) ? slope : std::numeric_limits<double>::infinity();
}

// The even grid's.
double error_of(const Diagram &diagram, const DiagramGrid &grid) {
  if (grid.row_length == 0)
    return grid_error(diagram.theta_rad, grid.theta_steps_per_rad,
                      [&](double place) { return value_at(diagram.relative, place); });
  const auto same = [](double place) { return place; };
  const glm::dvec2 steps = largest_steps(diagram);
  return grid_error(diagram.theta_rad, grid.theta_steps_per_rad, same) * steps.x +
         grid_error(around(diagram), grid.phi_steps / turn_rad, same) * steps.y;
}

// `steps` + 1 values, each with the next one; after the last it stays.
template <class ValueOf>
void append(std::uint32_t steps, std::vector<glm::vec2> &table, const ValueOf &value_of) {
  auto value = static_cast<float>(value_of(0));
  for (std::uint32_t step = 0; step <= steps; ++step) {
    const auto next = static_cast<float>(value_of(std::min(step + 1, steps)));
    table.emplace_back(value, next);
    value = next;
  }
}

// Appends a diagram that is not the same for all phi; `theta_place`: which of its angles a step of theta is.
template <class ThetaPlace>
void append_both(const Diagram &diagram, const ThetaPlace &theta_place, DiagramGrid &grid,
                 std::vector<glm::vec2> &table) {
  const std::vector<double> phis = around(diagram);
  grid.phi_steps = even_steps(phis, turn_rad).value_or(most_steps);
  grid.row_length = static_cast<std::uint32_t>(diagram.theta_rad.size());
  append(grid.theta_steps, table, theta_place);
  append(grid.phi_steps, table, [&](std::uint32_t step) {
    return place_among(phis, phis.front() + turn_rad * step / grid.phi_steps);
  });
  for (std::size_t phi = 0; phi < phis.size() + 1; ++phi) // and one more, which the last may ask for
    append(grid.row_length - 1, table, [&](std::uint32_t theta) {
      return diagram.relative[theta * diagram.phi_rad.size() + phi % diagram.phi_rad.size()];
    });
}

} // namespace

double relative_at(const Diagram &diagram, double theta_rad, double phi_rad) {
  if (theta_rad < diagram.theta_rad.front() || theta_rad > diagram.theta_rad.back())
    return 0.0;
  const std::size_t columns = diagram.phi_rad.size();
  const double row = place_among(diagram.theta_rad, theta_rad),
               column = place_around(diagram.phi_rad, phi_rad);
  const auto at_theta = [&](std::size_t t) {
    const auto first = static_cast<std::size_t>(column);
    const auto j = [&](std::size_t p) { return diagram.relative[t * columns + p % columns]; };
    return std::lerp(j(first), j(first + 1), column - static_cast<double>(first));
  };
  const auto above = static_cast<std::size_t>(row);
  const std::size_t below = std::min(above + 1, diagram.theta_rad.size() - 1);
  return std::lerp(at_theta(above), at_theta(below), row - static_cast<double>(above));
}

double diagram_slope(const Diagram &diagram) {
  return largest_change(diagram, [](double) { return std::numbers::pi; }) +
         (diagram.phi_rad.size() > 1 ? slope_in_phi(diagram) : 0.0);
}

double diagram_error(const Diagram &diagram, const DiagramGrid &grid, double radius_over_range) {
  const double of_theta =
      largest_change(diagram, [&](double theta_rad) { return theta_error_u(radius_over_range, theta_rad); });
  const double of_phi =
      diagram.phi_rad.size() > 1 ? phi_error_u(radius_over_range) * slope_in_phi(diagram) : 0.0;
  return grid.error + 0x1p-24 * (of_theta + of_phi);
}

DiagramGrid DiagramTables::grid_of(const std::shared_ptr<const Diagram> &diagram) {
  const auto [found, is_new] = grids_.try_emplace(diagram);
  DiagramGrid &grid = found->second;
  if (!is_new)
    return grid;
  const std::vector<double> &thetas = diagram->theta_rad;
  const double span_rad = thetas.back() - thetas.front();
  const std::uint32_t theta_steps = even_steps(thetas, span_rad).value_or(most_steps);
  grid.first_value = static_cast<std::uint32_t>(values_.size());
  grid.first_theta_rad = thetas.front();
  grid.theta_steps_per_rad = theta_steps > 0 ? theta_steps / span_rad : 1.0;
  // Straight behind the diode rounding must not lead beyond the last angle: a step more of the same.
  grid.theta_steps = theta_steps + (std::abs(thetas.back() - std::numbers::pi) < 1e-9 ? 1 : 0);
  grid.first_phi_rad = diagram->phi_rad.front();
  const auto theta_place = [&](std::uint32_t step) {
    return place_among(thetas, thetas.front() + step / grid.theta_steps_per_rad);
  };
  if (diagram->phi_rad.size() == 1)
    append(grid.theta_steps, values_,
           [&](std::uint32_t step) { return value_at(diagram->relative, theta_place(step)); });
  else
    append_both(*diagram, theta_place, grid, values_);
  grid.error = error_of(*diagram, grid);
  return grid;
}

} // namespace pmdsim
