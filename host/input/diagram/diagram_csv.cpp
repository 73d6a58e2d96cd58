#include "host/input/diagram/csv_table.h"
#include "host/input/diagram/diagram_table.h"

#include <algorithm>
#include <tuple>

namespace pmdsim {
namespace {

constexpr std::array<const char *, 4> columns = {"angle_deg", "theta_deg", "phi_deg", "relative"};
enum Column : std::size_t { angle, theta, phi, relative };
using Table = CsvTable<columns.size()>;

constexpr NumberRange to_axis_deg{0.0, 180.0};
constexpr NumberRange about_axis_deg{0.0, 360.0};

struct Row {
  double theta_deg, phi_deg;
  DiagramTable::Value value;
};

// Whether it depends on phi.
bool is_two_dimensional(const Table &table) {
  const bool one = table.has(angle) && !table.has(theta) && !table.has(phi);
  const bool two = !table.has(angle) && table.has(theta) && table.has(phi);
  if (!table.has(relative) || (!one && !two))
    throw input_error(table.here(),
                      "expected the columns angle_deg, relative or theta_deg, phi_deg, relative");
  return two;
}

std::vector<Row> rows_of(Table &table, bool two_dimensional) {
  std::vector<Row> rows;
  while (table.next_row()) {
    if (rows.size() == max_diagram_values)
      throw input_error(table.here(), fmt::format("expected at most {} directions", max_diagram_values));
    rows.push_back({table.number(two_dimensional ? theta : angle, to_axis_deg),
                    two_dimensional ? table.number(phi, about_axis_deg) : 0.0,
                    {table.number(relative, {0.0, max_diagram_value}), table.here().line}});
  }
  return rows;
}

// The different angles among the rows, ascending.
std::vector<double> distinct_angles(std::vector<Row> &rows, double Row::*angle_deg, const char *name,
                                    const std::filesystem::path &file) {
  std::ranges::sort(rows, {}, [&](const Row &row) { return std::tuple(row.*angle_deg, row.value.line); });
  std::vector<double> angles_deg;
  for (const Row &row : rows) {
    if (!angles_deg.empty() && row.*angle_deg == angles_deg.back())
      continue;
    if (!angles_deg.empty() && row.*angle_deg < angles_deg.back() + least_angle_step_deg)
      throw input_error(TextPlace{file, row.value.line},
                        fmt::format("{}: expected angles at least {} degrees apart, found {} beside {}", name,
                                    least_angle_step_deg, row.*angle_deg, angles_deg.back()));
    angles_deg.push_back(row.*angle_deg);
  }
  return angles_deg;
}

// Rows in the order of a grid, each direction once; `end` is where missing ones are missed.
void expect_grid(const std::vector<Row> &rows, const DiagramTable &table, const TextPlace &end) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i].theta_deg == rows[i - 1].theta_deg && rows[i].phi_deg == rows[i - 1].phi_deg)
      throw input_error(
          TextPlace{end.file, rows[i].value.line},
          fmt::format("theta {} with phi {} appears twice", rows[i].theta_deg, rows[i].phi_deg));
  const std::size_t phis = table.phi_deg.size();
  for (std::size_t i = 0; i < table.theta_deg.size() * phis; ++i) {
    const double theta_deg = table.theta_deg[i / phis];
    const double phi_deg = table.phi_deg[i % phis];
    if (i == rows.size() || rows[i].theta_deg != theta_deg || rows[i].phi_deg != phi_deg)
      throw input_error(end,
                        fmt::format("expected every theta with every phi, theta {} with phi {} is missing",
                                    theta_deg, phi_deg));
  }
}

DiagramTable listed(const std::filesystem::path &file, const std::vector<Row> &rows) {
  DiagramTable table{file, {}, {0.0}, {}};
  for (const Row &row : rows)
    append_ascending(table.theta_deg, row.theta_deg, columns[angle], TextPlace{file, row.value.line});
  return table;
}

DiagramTable grid(std::vector<Row> &rows, const TextPlace &end) {
  DiagramTable table{end.file,
                     distinct_angles(rows, &Row::theta_deg, columns[theta], end.file),
                     distinct_angles(rows, &Row::phi_deg, columns[phi], end.file),
                     {}};
  std::ranges::sort(rows, {},
                    [](const Row &row) { return std::tuple(row.theta_deg, row.phi_deg, row.value.line); });
  expect_grid(rows, table, end);
  return table;
}

} // namespace

DiagramTable read_diagram_csv(const std::filesystem::path &file, std::string_view text) {
  Table csv(file, text, columns, 0);
  const bool two_dimensional = is_two_dimensional(csv);
  std::vector<Row> rows = rows_of(csv, two_dimensional);
  DiagramTable table = two_dimensional ? grid(rows, csv.end()) : listed(file, rows);
  if (table.theta_deg.size() < 2)
    throw input_error(csv.end(), "expected at least two angles to the axis");
  table.values.reserve(rows.size());
  for (const Row &row : rows)
    table.values.push_back(row.value);
  close_turn(table);
  if (table.phi_deg.back() > 360.0 - least_angle_step_deg)
    throw input_error(TextPlace{file, table.at(0, table.phi_deg.size() - 1).line},
                      "phi_deg: expected less than 360, or 360 itself");
  return table;
}

} // namespace pmdsim
