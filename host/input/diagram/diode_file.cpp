#include "host/input/diagram/diode_file.h"

#include "host/input/diagram/csv_table.h"
#include "host/input/diagram/radiation_law.h"
#include "host/input/schema/limits.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

glm::dvec3 without_roll(const glm::dvec3 &axis) {
  const double off_z = axis.x * axis.x + axis.y * axis.y;
  if (off_z == 0.0)
    return {1.0, 0.0, 0.0};
  // 1 / (1 + z), without cancellation near -z.
  const double factor = axis.z >= 0.0 ? 1.0 / (1.0 + axis.z) : (1.0 - axis.z) / off_z;
  const glm::dvec3 across(1.0 - axis.x * axis.x * factor, -axis.x * axis.y * factor, -axis.x);
  return glm::normalize(across - glm::dot(across, axis) * axis);
}

constexpr std::array<const char *, 9> columns = {
    "x_m", "y_m", "z_m", "axis_x", "axis_y", "axis_z", "intensity_w_sr", "pattern", "roll_deg"};
enum Column : std::size_t { x_m, y_m, z_m, axis_x, axis_y, axis_z, intensity_w_sr, pattern, roll_deg };
using Table = CsvTable<columns.size()>;

constexpr NumberRange coordinates_m{-max_coordinate_m, max_coordinate_m};
constexpr NumberRange intensities_w_sr{0.0, max_intensity_w_sr};
constexpr NumberRange rolls_deg{-max_roll_deg, max_roll_deg};

glm::dvec3 unit_axis(const Table &row) {
  const glm::dvec3 axis(row.number(axis_x), row.number(axis_y), row.number(axis_z));
  const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  if (largest == 0.0)
    throw input_error(row.at(axis_x), "expected an axis, as 0, 0, 1 is, found zero");
  return glm::normalize(axis / largest);
}

Diode diode_of(const Table &row, DiagramFiles &diagrams) {
  Diode diode;
  diode.position_m = {row.number(x_m, coordinates_m), row.number(y_m, coordinates_m),
                      row.number(z_m, coordinates_m)};
  diode.axis = unit_axis(row);
  diode.intensity_w_sr = row.number(intensity_w_sr, intensities_w_sr);
  diode.pattern = law_in_field(row.text(pattern), row.here(), diagrams);
  const double roll = row.has(roll_deg) ? row.number(roll_deg, rolls_deg) : 0.0;
  diode.across = diode_across(diode.axis, glm::radians(roll));
  return diode;
}

} // namespace

glm::dvec3 diode_across(const glm::dvec3 &axis, double roll_rad) {
  const glm::dvec3 across = without_roll(axis);
  return std::cos(roll_rad) * across + std::sin(roll_rad) * glm::cross(axis, across);
}

std::vector<Diode> read_diode_file(const std::filesystem::path &file, const Place &named_at,
                                   DiagramFiles &diagrams) {
  const std::string text = read_text_file(file, named_at);
  Table table(file, text, columns, roll_deg);
  std::vector<Diode> diodes;
  while (table.next_row()) {
    if (diodes.size() == max_diodes)
      throw input_error(table.here(), fmt::format("expected at most {} diodes", max_diodes));
    diodes.push_back(diode_of(table, diagrams));
  }
  if (diodes.empty())
    throw input_error(table.end(), "expected at least one diode");
  return diodes;
}

} // namespace pmdsim
