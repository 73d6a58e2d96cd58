#pragma once
// The judge: the same measurement by the CPU in double precision, with its own ray casting and the standard
// library's trigonometry. Shares no code with the shaders, the passes, their projection or
// engine/lens/lens.h.

#include "engine/model/bounces.h"
#include "engine/model/illuminator.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/reference/surface_point.h"

#include <complex>
#include <functional>
#include <optional>
#include <vector>

namespace pmdsim::reference {

// Channels as in Measurement, row-major, before anything is rounded to float. `z` is what the
// camera forms from its taps; for a sine, eq. 5 to 7's mean complex return.
struct FrameReturn {
  double ambiguity_m = 0.0; // c / (2 f), where distance_m wraps
  std::vector<std::complex<double>> z;
  std::vector<double> amplitude, phase_rad, distance_m;
  std::vector<std::vector<double>> taps; // c_k, k = 0 ... N-1
  // The sum of the paths' weights over |z|: how many times larger than its terms' the error of z may be. At
  // least 1 for a sine; infinity where all cancels, NaN where no light returns.
  std::vector<double> condition;
  // With bounces, else empty: what they are in Return. All above includes them.
  std::vector<std::complex<double>> direct_z{};
  std::vector<double> direct_amplitude{}, direct_phase_rad{}, direct_distance_m{};
  std::vector<double> multipath_m{};
  std::vector<double> multipath_error_m{}; // the standard error of multipath_m
  std::vector<double> indirect_share{};    // 1 where no light comes directly
  std::vector<double> z_error{};           // the standard error of z: of both of its parts, squared and added
};

struct Frame {
  glm::uvec2 resolution{0, 0};
  std::vector<FrameReturn> returns; // beside Sensor::modulation_hz
  std::vector<double> range_m, z_m, coverage;
  std::vector<double> mean_radiance;                 // as in Measurement
  std::vector<double> lit;                           // as in Measurement
  std::vector<std::uint32_t> triangle_id, object_id; // a disc's id is as Scene::surface_of takes it
  std::vector<std::uint32_t> sample_triangle_id;     // (S*rows) x (S*columns)
  std::vector<std::uint32_t> sample_visibility;      // as in Measurement, only filled on request
  // Beside sample_triangle_id, nothing where nothing is hit; only filled on request.
  std::vector<std::optional<SurfacePoint>> sample_points;
  double frame_ms = 0.0;
};

struct Options {
  Shadows shadows = Shadows::off;
  bool keep_visibility = false; // fill Frame::sample_visibility
  // Only these pixels, row * columns + column, in this order, as a frame of one column; empty: all.
  std::vector<std::uint32_t> pixels{};
  // Light that bounces, for Backscatter::lambert only (else throws std::logic_error). Discs receive it, but
  // neither send nor block it.
  Bounces bounces{};
  // Of light that bounces to a pixel, spread over its samples; rounded up to a multiple of 16; 0: 1024.
  std::uint32_t paths = 0;
  bool keep_points = false; // fill Frame::sample_points
};

// Samples whose place on the chip no ray reaches see nothing. `progress` is called with the fraction done,
// from one thread only; may throw to stop.
Frame simulate(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators,
               Backscatter backscatter, const Options &options = {},
               const std::function<void(double)> &progress = {});

// The integral of J over all directions: 4 pi for an isotropic diode, 2 pi / (n + 1) for a cosine of order n,
// and for a diagram that of its interpolation, exactly.
double solid_angle_sr(const Pattern &pattern);

// Rounded to the float channels that the simulator gives, and unrounded beside them.
Measurement to_measurement(const Frame &frame);

// Puts the noisy channels of a frame of a sensor with electronics in place of the noiseless ones of
// `measurement`, which has the frame's number. `keep_taps`: fill the channels of taps. `between` is called
// now and then; may throw to stop.
void count_electrons(const Frame &frame, const Sensor &sensor, bool keep_taps, Measurement &measurement,
                     const std::function<void()> &between = {});

} // namespace pmdsim::reference
