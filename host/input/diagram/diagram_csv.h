#pragma once
// Radiation diagrams as CSV: a header line and the columns angle_deg, relative (the same all around the axis)
// or theta_deg, phi_deg, relative, in any order. `relative` is in any scale.
//
// angle_deg and theta_deg are angles to the diode's axis, 0 to 180, two or more; angle_deg is ascending.
// phi_deg turns about the axis, right-handed, from Diode::across: 0 to below 360, or to 360 where 0 is there
// and has the same values. Lines of theta and phi come in any order, every theta once with every phi. Beyond
// the first and the last angle to the axis it is dark.

#include "host/input/diagram/diagram_table.h"

#include <string_view>

namespace pmdsim {

// With its turn closed. `text` is the file's, without a NUL. Throws Error (input): "FILE:LINE: ...".
DiagramTable read_diagram_csv(const std::filesystem::path &file, std::string_view text);

} // namespace pmdsim
