#pragma once
// Units that tests are written in.

#include <numbers>

namespace pmdsim::test {

inline constexpr double full_turn_rad = 2.0 * std::numbers::pi;
inline constexpr double degree = full_turn_rad / 360.0;
inline constexpr double wavenumber_20mhz_rad_m = full_turn_rad * 20e6 / 299792458.0;

} // namespace pmdsim::test
