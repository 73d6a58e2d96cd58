#pragma once
// Lengths as people write them, with their unit.

#include <optional>
#include <string_view>

namespace pmdsim {

// A length such as "0.1mm": a number and m, mm or um, 1e-9 m to 1e6 m; nothing where the text is none.
std::optional<double> length_m(std::string_view text);

inline constexpr double least_written_length_m = 1e-9, largest_written_length_m = 1e6;

} // namespace pmdsim
