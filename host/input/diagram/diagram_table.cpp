#include "host/input/diagram/diagram_table.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double same_direction = 0.01; // of the maximum: how far values of one direction may lie apart
constexpr double dark_axis = 1e-6;      // of the maximum

double maximum_of(const DiagramTable &table) {
  return std::ranges::max(table.values, {}, &DiagramTable::Value::relative).relative;
}

// Exact at 90, 180 and 360 degrees.
std::vector<double> radians(const std::vector<double> &degrees) {
  std::vector<double> result;
  result.reserve(degrees.size());
  for (const double angle : degrees)
    result.push_back(angle / 180.0 * std::numbers::pi);
  return result;
}

void drop_last_phi(DiagramTable &table) {
  const std::size_t phis = table.phi_deg.size();
  std::vector<DiagramTable::Value> kept;
  kept.reserve(table.values.size());
  for (std::size_t i = 0; i < table.values.size(); ++i)
    if (i % phis != phis - 1)
      kept.push_back(table.values[i]);
  table.values = std::move(kept);
  table.phi_deg.pop_back();
}

// Gives all phi of the axis their mean, which is returned.
double merge_axis(DiagramTable &table, double maximum) {
  const std::size_t phis = table.phi_deg.size();
  const double first = table.at(0, 0).relative;
  double mean = first; // exact where all are equal
  for (std::size_t phi = 0; phi < phis; ++phi) {
    const auto [relative, line] = table.at(0, phi);
    if (std::abs(relative - first) > same_direction * maximum)
      throw input_error(
          TextPlace{table.file, line},
          fmt::format("expected on the axis, which is one direction, the same value all around (within "
                      "1 % of the maximum), found {} and {}",
                      first, relative));
    mean += (relative - first) / static_cast<double>(phis);
  }
  for (std::size_t phi = 0; phi < phis; ++phi)
    table.at(0, phi).relative = mean;
  return mean;
}

} // namespace

void append_ascending(std::vector<double> &angles_deg, double angle_deg, const char *what,
                      const TextPlace &place) {
  if (!angles_deg.empty() && !(angle_deg >= angles_deg.back() + least_angle_step_deg))
    throw input_error(place, fmt::format("{}: expected ascending angles, found {} after {}", what, angle_deg,
                                         angles_deg.back()));
  angles_deg.push_back(angle_deg);
}

void close_turn(DiagramTable &table) {
  if (table.phi_deg.back() != 360.0)
    return;
  const std::size_t last = table.phi_deg.size() - 1;
  if (table.phi_deg.front() != 0.0)
    throw input_error(TextPlace{table.file, table.at(0, last).line},
                      "expected an angle below 360 about the axis, or 0 beside 360");
  const double maximum = maximum_of(table);
  for (std::size_t theta = 0; theta < table.theta_deg.size(); ++theta) {
    const auto [relative, line] = table.at(theta, last);
    if (std::abs(relative - table.at(theta, 0).relative) > same_direction * maximum)
      throw input_error(TextPlace{table.file, line},
                        fmt::format("expected at 360 degrees what 0 has, {} (within 1 % of the maximum), "
                                    "found {}",
                                    table.at(theta, 0).relative, relative));
  }
  drop_last_phi(table);
}

Diagram diagram_of(DiagramTable table, std::vector<Warning> &warnings) {
  const double maximum = maximum_of(table);
  if (maximum == 0.0)
    throw input_error(TextPlace{table.file, table.values.back().line},
                      "expected light in some direction, found only zeros");
  const double on_axis = table.theta_deg.front() == 0.0 ? merge_axis(table, maximum) : 0.0;
  const bool is_dark = on_axis < dark_axis * maximum;
  if (is_dark)
    warnings.push_back(input_warning(
        warning_code("dark-diagram-axis"), Place{table.file},
        "the diagram is dark on its axis, normalised to its maximum: intensity_w_sr is then that of the "
        "brightest direction; if the axis is to be bright, begin the table at 0 degrees"));
  Diagram diagram{radians(table.theta_deg), radians(table.phi_deg), {}};
  diagram.relative.reserve(table.values.size());
  for (const DiagramTable::Value &value : table.values)
    diagram.relative.push_back(value.relative / (is_dark ? maximum : on_axis));
  return diagram;
}

} // namespace pmdsim
