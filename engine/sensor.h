#pragma once
// The camera: chip, lens, pose and modulation, plain data in SI units.

#include "engine/pose.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace pmdsim {

inline constexpr double speed_of_light_m_s = 299792458.0;

struct Sensor {
  std::string name = "pmd";
  glm::uvec2 resolution{640, 640};                                   // columns, rows
  glm::dvec2 pixel_pitch_m{45e-6, 45e-6};                            // along the columns, along the rows
  double focal_length_m = 0.144;                                     // of the thin lens
  double focus_distance_m = std::numeric_limits<double>::infinity(); // S1, lens to object, >= focal_length_m
  Pose world_from_camera = node_from_camera(); // camera frame: x right, y down, z forward, origin at the lens
  double modulation_hz = 20e6;
  std::uint32_t samples = 1; // S: S x S samples a pixel, 1 to 16

  // S2 of the thin lens, 1/S1 + 1/S2 = 1/f (paper, section 2.1).
  double image_distance_m() const {
    return std::isinf(focus_distance_m) ? focal_length_m
                                        : focal_length_m / (1.0 - focal_length_m / focus_distance_m);
  }
  // The distance at which the phase wraps, c / (2 f).
  double ambiguity_m() const { return speed_of_light_m_s / (2.0 * modulation_hz); }
  std::uint64_t pixel_count() const { return std::uint64_t{resolution.x} * resolution.y; }
};

} // namespace pmdsim
