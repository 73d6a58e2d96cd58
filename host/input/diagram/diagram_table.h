#pragma once
// A radiation diagram as a file lists it, and how it becomes the engine's.

#include "engine/model/illuminator.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <string>
#include <vector>

namespace pmdsim {

inline constexpr std::size_t max_diagram_values = std::size_t{1} << 20; // that a file may list
inline constexpr double max_diagram_value = 1e30;
inline constexpr double least_angle_step_deg = 1e-6; // closer angles would be one, once they are in radians

// A full grid of directions, in any scale: a value for every theta with every phi.
struct DiagramTable {
  struct Value {
    double relative;  // 0 to max_diagram_value
    std::size_t line; // of the file, that lists it
  };

  std::filesystem::path file;
  std::vector<double> theta_deg; // to the axis, 0 to 180, by a step or more apart
  std::vector<double> phi_deg; // about the axis, 0 to 360, by a step or more apart; a single one: all around
  std::vector<Value> values;   // phi_deg.size() of them for each theta in turn

  const Value &at(std::size_t theta, std::size_t phi) const { return values[theta * phi_deg.size() + phi]; }
  Value &at(std::size_t theta, std::size_t phi) { return values[theta * phi_deg.size() + phi]; }
};

// Takes out phi = 360, which is 0 again. Throws Error (input) where 0 is missing, or differs by more than 1 %
// of the maximum.
void close_turn(DiagramTable &table);

// The shape alone, 1 on the axis, where all phi are one direction and their mean counts. A diagram whose axis
// is dark (below 1e-6 of its maximum, or not in the table) is 1 at its maximum instead, and `warnings` says
// so. `table` has its turn closed. Throws Error (input) where values on the axis differ by more than 1 % of
// the maximum, or all are 0.
Diagram diagram_of(DiagramTable table, std::vector<std::string> &warnings);

} // namespace pmdsim
