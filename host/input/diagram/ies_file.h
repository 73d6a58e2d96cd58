#pragma once
// Radiation diagrams as IES LM-63 (1986, 1991, 1995, 2002, 2019), type C photometry.
//
// Nadir, vertical angle 0, is the diode's axis, and the plane of the horizontal angle 0 that of
// Diode::across. Horizontal angles run counter-clockwise as seen from above the luminaire, that is, along the
// axis from behind the diode, where right-handed angles run clockwise: phi = -horizontal angle. In an
// illuminator's frame with the axis along +z, horizontal angle 0 is to the right (+x) and 90 is up (-y).
// Lumens, multipliers, ballast factors and dimensions say nothing about the shape and are not used.

#include "host/input/diagram/diagram_table.h"

#include <string_view>

namespace pmdsim {

// Over the whole turn, with its symmetries unfolded. `text` is the file's, without a NUL. Throws Error
// (input): "FILE:LINE: ...".
DiagramTable read_ies(const std::filesystem::path &file, std::string_view text);

} // namespace pmdsim
