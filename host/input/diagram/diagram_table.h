#pragma once
// Radiation diagrams as files list them, and how they become the engine's.

#include "engine/model/illuminator.h"
#include "host/input/file/input_error.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
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

// Throws Error (input) at `place` where the angle, which is a `what`, is not a step above the last one.
void append_ascending(std::vector<double> &angles_deg, double angle_deg, const char *what,
                      const TextPlace &place);

// Takes out phi = 360, which is 0 again. Throws Error (input) where 0 is missing, or differs by more than 1 %
// of the maximum.
void close_turn(DiagramTable &table);

// The shape alone, 1 on the axis, where all phi are one direction and their mean counts. A diagram whose axis
// is dark (below 1e-6 of its maximum, or not in the table) is 1 at its maximum instead, and `warnings` says
// so. `table` has its turn closed. Throws Error (input) where values on the axis differ by more than 1 % of
// the maximum, or all are 0.
Diagram diagram_of(DiagramTable table, std::vector<Warning> &warnings);

// Radiation diagrams as CSV: a header line and the columns angle_deg, relative (the same all around the axis)
// or theta_deg, phi_deg, relative, in any order. `relative` is in any scale.
//
// angle_deg and theta_deg are angles to the diode's axis, 0 to 180, two or more; angle_deg is ascending.
// phi_deg turns about the axis, right-handed, from Diode::across: 0 to below 360, or to 360 where 0 is there
// and has the same values. Lines of theta and phi come in any order, every theta once with every phi. Beyond
// the first and the last angle to the axis it is dark.
//
// With its turn closed. `text` is the file's, without a NUL. Throws Error (input): "FILE:LINE: ...".
DiagramTable read_diagram_csv(const std::filesystem::path &file, std::string_view text);

// Radiation diagrams as IES LM-63 (1986, 1991, 1995, 2002, 2019), type C photometry.
//
// Nadir, vertical angle 0, is the diode's axis, and the plane of the horizontal angle 0 that of
// Diode::across. Horizontal angles run counter-clockwise as seen from above the luminaire, that is, along the
// axis from behind the diode, where right-handed angles run clockwise: phi = -horizontal angle. In an
// illuminator's frame with the axis along +z, horizontal angle 0 is to the right (+x) and 90 is up (-y).
// Lumens, multipliers, ballast factors and dimensions say nothing about the shape and are not used.
//
// Over the whole turn, with its symmetries unfolded. `text` is the file's, without a NUL. Throws Error
// (input): "FILE:LINE: ...".
DiagramTable read_ies(const std::filesystem::path &file, std::string_view text);

} // namespace pmdsim
