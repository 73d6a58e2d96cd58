#pragma once
// The camera: chip, lens, pose and modulation, plain data in SI units.

#include "engine/model/electronics.h"
#include "engine/model/pose.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace pmdsim {

inline constexpr double speed_of_light_m_s = 299792458.0;

// OpenCV's lens distortions. Both take the slopes (x, y) = (X/Z, Y/Z) of a ray (X, Y, Z) of the camera frame
// to the slopes (x', y') under which it meets the chip. Brown-Conrady, with r^2 = x^2 + y^2:
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
struct BrownConrady {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;
};
// Fisheye, theta the ray's angle to the optical axis, so that rays beyond 90 degrees have a place too:
//   (x', y') = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) * (X, Y) / |(X, Y)|
struct Fisheye {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, k4 = 0.0;
};
// No distortion is monostate, a pinhole.
using Distortion = std::variant<std::monostate, BrownConrady, Fisheye>;

// How far the chip stands from its nominal place (eq. 1): a point (x', y', 0) of it, seen in front of the
// lens, lies at D1(alpha) D2(beta) D3(gamma) (x', y', 0)^T + (0, 0, image distance) + translation_m in the
// camera frame; D1, D2, D3 are active, right-handed rotations about x, y, z.
struct Chip {
  glm::dvec3 rotation_rad{0.0}; // alpha, beta, gamma
  glm::dvec3 translation_m{0.0};

  bool is_nominal() const { return rotation_rad == glm::dvec3(0.0) && translation_m == glm::dvec3(0.0); }
};

// cos4: a ray at the angle theta to the optical axis counts cos^4 theta.
enum class Vignetting { none, cos4 };

// The correlation function C of light and reference, of the phase x (docs/theory.md, "The measurement"): cos
// x; the triangle wave (+1 at 0, -1 at pi) of square light on a square reference; or sum over h = 1, 2, ...
// of harmonics[h - 1] * cos(h x).
struct Waveform {
  enum class Kind { sine, square, harmonics };
  Kind kind = Kind::sine;
  std::vector<double> harmonics; // harmonics only, at least one
};

// Whether N taps take that harmonic for the fundamental: one that is not next to a multiple of N they make 0
// of (docs/theory.md, "Tones, harmonics and taps").
constexpr bool taps_show(std::size_t harmonic, std::size_t taps) {
  return harmonic % taps == 1 || harmonic % taps == taps - 1;
}

// A part of the light that is scattered inside the camera: a Gaussian on the chip.
struct ScatterLobe {
  double share = 0.0;   // of all light, 0 to 1; what is left of all lobes goes straight
  double sigma_m = 0.0; // standard deviation along either axis of the chip
};

struct Sensor {
  std::string name = "pmd";
  glm::uvec2 resolution{640, 640};        // columns, rows
  glm::dvec2 pixel_pitch_m{45e-6, 45e-6}; // along the columns, along the rows
  glm::dvec2 fill_factor{1.0, 1.0};       // active width and height over the pitch, centred
  double focal_length_m = 0.144;          // of the thin lens
  double focus_distance_m = std::numeric_limits<double>::infinity(); // S1, lens to object, > focal_length_m
  Distortion distortion;
  // Samples beyond where the distortion folds over, or where its model ends, see nothing, as behind a lens
  // whose image circle ends there. Without it a sensor with such samples is refused (engine/lens/lens.h).
  bool dark_beyond_fold = false;
  Chip chip;
  Vignetting vignetting = Vignetting::none;
  Pose world_from_camera = node_from_camera(); // camera frame: x right, y down, z forward, origin at the lens
  std::vector<double> modulation_hz{20e6};     // at least one
  Waveform waveform;
  std::uint32_t taps = 4; // N, correlation samples, 3 to 16; the k-th at the reference phase 2 pi k / N
  // From the exposure of one tap to the next's: frequency i's tap k is taken (i * N + k) of these after the
  // frame begins. The simulator and the reference measure one instant and leave it to their caller.
  double tap_interval_s = 0.0;
  std::uint32_t samples = 1; // S: S x S samples a pixel, 1 to 16
  // A pixel that sees one smooth surface, unshadowed, may take fewer, as far as Accuracy::max_error_m bears.
  bool adaptive_samples = false;
  // Without it the camera is noiseless. With it the simulator and the reference fill
  // Measurement::mean_radiance, of which engine/electronics makes electrons.
  std::optional<Electronics> electronics;
  // Scatter inside the camera (engine/electronics/scatter.h); empty: none. The simulator leaves it to its
  // caller.
  std::vector<ScatterLobe> scatter;
  // Distances are unwrapped from all frequencies within so much, from 0 on (engine/signal/unwrapping.h); 0:
  // they are not. Likewise.
  double unwrap_range_m = 0.0;

  // S2 of the thin lens, 1/S1 + 1/S2 = 1/f (paper, section 2.1).
  double image_distance_m() const {
    return std::isinf(focus_distance_m) ? focal_length_m
                                        : focal_length_m / (1.0 - focal_length_m / focus_distance_m);
  }
  // The distance at which the phase of a frequency wraps, c / (2 f).
  double ambiguity_m(std::size_t frequency = 0) const {
    return speed_of_light_m_s / (2.0 * modulation_hz[frequency]);
  }
  bool has_distortion() const { return !std::holds_alternative<std::monostate>(distortion); }
  std::uint64_t pixel_count() const { return std::uint64_t{resolution.x} * resolution.y; }
};

} // namespace pmdsim
