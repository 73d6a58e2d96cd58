#pragma once
// The largest values that an input may hold. Beyond any real camera, scene or light, and far enough from the
// range of float that nothing computed from them overflows. setup.schema.json states them too.

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace pmdsim {

inline constexpr double max_coordinate_m = 1e9; // of a position, to either side of its frame's origin
inline constexpr double max_intensity_w_sr = 1e30;
inline constexpr double max_roll_deg = 3600.0;    // of a diagram about its axis, to either side
inline constexpr double max_modulation_hz = 1e12; // of a waveform's highest harmonic too
inline constexpr std::uint32_t max_resolution = 8192;
inline constexpr double min_length_m = 1e-9, max_length_m = 1e3; // of a focal length and a pixel's pitch
inline constexpr double max_distortion = 1e6;                    // of a coefficient, to either side of 0
inline constexpr double max_chip_tilt_deg = 89.0;                // about x and y
inline constexpr double max_chip_shift_m = 1e3;                  // along an axis

// False also for what is not finite.
inline bool is_position(const glm::dvec3 &position_m) {
  return std::abs(position_m.x) <= max_coordinate_m && std::abs(position_m.y) <= max_coordinate_m &&
         std::abs(position_m.z) <= max_coordinate_m;
}

} // namespace pmdsim
