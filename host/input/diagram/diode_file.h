#pragma once
// Diode files: CSV with a header line and the columns x_m, y_m, z_m (position), axis_x, axis_y, axis_z
// (normalised when read), intensity_w_sr (>= 0), pattern (a field of radiation_law.h) and, where it is
// wanted, roll_deg (of a diagram about the axis, see diode_across()), in any order, one diode a line, all in
// the illuminator's frame. Blank lines are skipped. limits.h bounds the values.

#include "engine/model/illuminator.h"
#include "host/input/diagram/radiation_law.h"
#include "host/input/file/input_error.h"

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// Diode::across: the illuminator's +x, carried along by the smallest rotation that takes +z to the axis (for
// -z: half a turn about x), then turned by `roll_rad`, right-handed about the axis. `axis` has unit length.
glm::dvec3 diode_across(const glm::dvec3 &axis, double roll_rad);

inline constexpr std::size_t max_diodes = 100'000;

// At least one diode. Throws Error (input): "FILE:LINE: ..."; a file that cannot be read at `named_at`.
std::vector<Diode> read_diode_file(const std::filesystem::path &file, const Place &named_at,
                                   DiagramFiles &diagrams);

} // namespace pmdsim
