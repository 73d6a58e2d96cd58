#include "host/commands/accuracy_check.h"

#include "engine/error.h"
#include "host/commands/camera.h"
#include "host/commands/coarser_sensor.h"
#include "host/commands/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {
namespace {

constexpr double affordable_interactions = 2e8; // some seconds of the reference

// With few enough pixels for what the reference can afford.
Sensor affordable(const Sensor &sensor, std::size_t diode_count) {
  const double interactions = static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples *
                              static_cast<double>(diode_count);
  return coarser(sensor, std::sqrt(interactions / affordable_interactions));
}

// Whether every sample of the pixel hits the same triangle in both.
bool same_triangles(const Measurement &a, const reference::Frame &b, std::uint32_t column, std::uint32_t row,
                    std::uint32_t samples) {
  const std::size_t sample_columns = std::size_t{a.resolution.x} * samples;
  for (std::size_t y = std::size_t{row} * samples; y < std::size_t{row + 1} * samples; ++y) {
    const auto first = static_cast<std::ptrdiff_t>(y * sample_columns + std::size_t{column} * samples);
    const auto begin = a.sample_triangle_id.begin() + first;
    if (!std::equal(begin, begin + samples, b.sample_triangle_id.begin() + first))
      return false;
  }
  return true;
}

// Beyond it the device computes something else: float32 holds a distance to 6e-8 of the ambiguity range.
double largest_plausible_error_m(const Sensor &sensor) {
  return std::max(10e-6, 1e-6 * sensor.ambiguity_m());
}

} // namespace

AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor) {
  AccuracyCheck check{sensor.resolution, 0, 0, 0, std::numeric_limits<double>::quiet_NaN()};
  const double darkest =
      1e-3 * *std::max_element(truth.returns[0].amplitude.begin(), truth.returns[0].amplitude.end());
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
      if (!std::isfinite(truth.returns[0].distance_m[pixel]) ||
          !(truth.returns[0].amplitude[pixel] > darkest))
        continue;
      ++check.comparable;
      if (!same_triangles(found, truth, column, row, sensor.samples))
        continue;
      ++check.pixels;
      const double difference_m =
          static_cast<double>(found.returns[0].distance_m[pixel]) - truth.returns[0].distance_m[pixel];
      if (std::isfinite(difference_m))
        check.distance_max_m =
            std::fmax(check.distance_max_m, std::abs(std::remainder(difference_m, sensor.ambiguity_m())));
      else
        ++check.not_finite;
    }
  return check;
}

void require_plausible(const AccuracyCheck &check, const Sensor &sensor, const std::string &device) {
  const auto fail = [&](const std::string &what) {
    throw Error(ExitCode::internal, fmt::format("{}: {}", device, what));
  };
  // Rounding moves samples to another triangle at edges only.
  if (2 * check.pixels < check.comparable)
    fail(fmt::format("sees the reference's triangles in {} of {} pixels; expected at least half",
                     check.pixels, check.comparable));
  if (check.not_finite > 0)
    fail(fmt::format("distances are not finite in {} of {} pixels where the reference's are",
                     check.not_finite, check.pixels));
  const double limit_m = largest_plausible_error_m(sensor);
  if (check.distance_max_m > limit_m)
    fail(fmt::format("distances differ from the reference by up to {:.6g} mm; expected at most {:.6g} mm",
                     1e3 * check.distance_max_m, 1e3 * limit_m));
}

AccuracyCheck check_accuracy(const Setup &setup, const std::string &device) {
  const Illuminator &illuminator = setup.illuminators.front();
  const Sensor sensor = affordable(setup.sensors.front(), illuminator.diodes.size());
  Camera camera(device, Camera::SampleTriangles::keep);
  camera.prepare(setup.scene, sensor, illuminator, setup.backscatter);
  const Measurement found = camera.measure("measuring what is checked");
  ProgressBar bar("checking against the reference");
  const reference::Frame truth =
      reference::simulate(setup.scene, sensor, illuminator, setup.backscatter, interruptible_progress(bar));
  return compare(found, truth, sensor);
}

} // namespace pmdsim
