#pragma once
// From a measured phase image back to the surface: for each pixel the range at which eq. 5 to 7's return, of
// the given diodes, has the measured phase (docs/correct.md). It shares no code with what makes images.
// Solved in double. For direct light; what bounces, scatters or is blocked is not known here.

#include "engine/model/illuminator.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace pmdsim {

// Row-major, row 0 at the top, rows * columns values.
struct MeasuredImage {
  std::vector<double> phase_rad; // of any turn; not finite where nothing was measured
  // The range within half of the ambiguity range, or not finite where it is not known; empty: of no pixel.
  std::vector<double> guess_m{};
  double step_m = 0.0; // between the distances that it can tell apart, as of whole millimetres; 0: of none
};

enum class NormalsFrom {
  neighbours, // planes fitted to the corrected points around
  facing,     // every surface faces the lens
};

struct CorrectionOptions {
  std::size_t frequency = 0; // the image's, an index of Sensor::modulation_hz
  Backscatter backscatter = Backscatter::lambert;
  double least_range_m = 0.0; // of each pixel without a guess: its range is so much or more, less than one
                              // ambiguity range more
  NormalsFrom normals = NormalsFrom::neighbours;
  // Pixels to each side that planes are fitted to, 1 to 16; 0: by the noise that is found.
  std::uint32_t fit_pixels = 0;
};

// What became of a pixel.
enum class PixelStatus : std::uint32_t {
  corrected = 0,
  // Corrected, but its normal, on which its range depends, is of a plane beside the pixel, or so uncertain
  // that the range is by more than CorrectedImage::edge_limit_m. At steps and edges, in pixels that mix two
  // surfaces, on thin things.
  edge = 1,
  not_measured = 2, // the image has no number there, or the lens no ray
  no_light = 3,     // no diode lights any point of the ray
  not_converged = 4,
};
inline constexpr std::size_t status_count = 5;

struct CorrectedImage {
  std::vector<double> range_m;        // from the lens along the pixel's ray; NaN where it is not corrected
  std::vector<double> correction_m;   // the measured distance, in the turn of the range, minus the range
  std::vector<double> normal_error_m; // how far the range may be off by its normal, estimated; NaN likewise
  std::vector<glm::dvec3> ray;        // through the pixel's centre, camera frame, unit length; 0 where none
  std::vector<glm::dvec3> normal;     // camera frame, unit length, towards the lens
  std::vector<std::uint32_t> status;  // PixelStatus
  std::size_t counts[status_count] = {};
  double noise_m = 0.0; // of single ranges, found where neighbours disagree, or of the image's steps if that
  // is more; NaN where it is not known
  double edge_limit_m = 0.0;    // of PixelStatus::edge: 2 um, or what noise makes of most normals
  std::uint32_t fit_pixels = 0; // that were used
  std::uint32_t passes = 0;
  double last_change_m = 0.0; // the largest, of any corrected pixel, by the last pass
};

// `illuminators` in the world frame, at the time of the image. The pixel's measure is the mean over
// Sensor::samples x samples points of its active area, as that of a plane through its point; 1: its centre.
// `progress` is called with the fraction done, on the calling thread; may throw to stop. Throws
// std::logic_error where the image is not of the sensor's size.
CorrectedImage correct(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                       const MeasuredImage &image, const CorrectionOptions &options,
                       const std::function<void(double)> &progress = {});

// The distance of a phase, c phase / (4 pi f), and its inverse.
double distance_of_phase_m(double phase_rad, double modulation_hz);
double phase_of_distance_rad(double distance_m, double modulation_hz);

} // namespace pmdsim
