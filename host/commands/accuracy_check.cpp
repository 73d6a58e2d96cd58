#include "host/commands/accuracy_check.h"

#include "engine/error.h"
#include "host/commands/camera.h"
#include "host/commands/coarser_sensor.h"
#include "host/commands/progress_bar.h"
#include "host/commands/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr double affordable_interactions = 2e8; // some seconds of the reference

// What the reference does for one path, in sines: every frequency has its own correlation function.
double terms_per_path(const Sensor &sensor) {
  const Waveform &waveform = sensor.waveform;
  const double terms = waveform.kind == Waveform::Kind::harmonics
                           ? static_cast<double>(waveform.harmonics.size())
                       : waveform.kind == Waveform::Kind::square ? sensor.taps
                                                                 : 1.0;
  return terms * static_cast<double>(sensor.modulation_hz.size());
}

double interactions(const Sensor &sensor, std::size_t diode_count) {
  return static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples *
         static_cast<double>(diode_count) * terms_per_path(sensor);
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

// In W/(m^2 sr).
double darkest_comparable(const reference::FrameReturn &truth) {
  double brightest = std::ranges::max(truth.amplitude);
  for (const std::vector<double> &tap : truth.taps)
    for (const double value : tap)
      brightest = std::max(brightest, std::abs(value));
  return 1e-3 * brightest;
}

// Beyond it the device computes something else: float32 holds a distance to 6e-8 of the ambiguity range.
double largest_plausible_error_m(double ambiguity_m) { return std::max(10e-6, 1e-6 * ambiguity_m); }

void add_difference(AccuracyCheck &check, double difference_m) {
  ++check.pixels;
  if (std::isfinite(difference_m))
    check.distance_max_m =
        std::fmax(check.distance_max_m, std::abs(std::remainder(difference_m, check.ambiguity_m)));
  else
    ++check.not_finite;
}

} // namespace

AccuracyCheck compare(const Measurement &found, const reference::Frame &truth, const Sensor &sensor,
                      std::size_t frequency) {
  AccuracyCheck check{sensor.name, sensor.modulation_hz[frequency], sensor.ambiguity_m(frequency),
                      sensor.resolution};
  const reference::FrameReturn &expected = truth.returns[frequency];
  const std::vector<float> &found_m = found.returns[frequency].distance_m;
  const double darkest = darkest_comparable(expected);
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
      if (!std::isfinite(expected.distance_m[pixel]) || !(expected.amplitude[pixel] > darkest))
        continue;
      ++check.comparable;
      if (same_triangles(found, truth, column, row, sensor.samples))
        add_difference(check, static_cast<double>(found_m[pixel]) - expected.distance_m[pixel]);
    }
  return check;
}

void require_plausible(const AccuracyCheck &check, const std::string &device) {
  const auto fail = [&](const std::string &what) {
    throw Error(ExitCode::internal, fmt::format("{}: sensor {} at {}: {}", device, check.sensor,
                                                frequency_text(check.modulation_hz), what));
  };
  // Rounding moves samples to another triangle at edges only.
  if (2 * check.pixels < check.comparable)
    fail(fmt::format("sees the reference's triangles in {} of {} pixels; expected at least half",
                     check.pixels, check.comparable));
  if (check.not_finite > 0)
    fail(fmt::format("distances are not finite in {} of {} pixels where the reference's are",
                     check.not_finite, check.pixels));
  const double limit_m = largest_plausible_error_m(check.ambiguity_m);
  if (check.distance_max_m > limit_m)
    fail(fmt::format("distances differ from the reference by up to {:.6g} mm; expected at most {:.6g} mm",
                     1e3 * check.distance_max_m, 1e3 * limit_m));
}

Sensor affordable(Sensor sensor, std::size_t diode_count, std::size_t sensors) {
  const double share = affordable_interactions / static_cast<double>(sensors);
  const auto coarse = [&] { return coarser(sensor, std::sqrt(interactions(sensor, diode_count) / share)); };
  if (interactions(coarse(), diode_count) > share)
    sensor.samples = 1;
  return coarse();
}

std::vector<AccuracyCheck> check_accuracy(const Setup &setup, const std::string &device) {
  const std::size_t diodes = diode_count(setup.start.illuminators);
  Camera camera(device, {.sample_triangles = true});
  std::vector<AccuracyCheck> checks;
  ProgressBar bar(2.0 * static_cast<double>(setup.start.sensors.size()));
  const auto progress = interruptible_progress(bar);
  for (const Sensor &fine : setup.start.sensors) {
    const Sensor sensor = affordable(fine, diodes, setup.start.sensors.size());
    camera.prepare(setup.start.scene, sensor, setup.start.illuminators, setup.backscatter);
    bar.begin("measuring what is checked", 1.0);
    const Measurement found = camera.measure(progress);
    bar.begin("checking against the reference", 1.0);
    const reference::Frame truth = reference::simulate(setup.start.scene, sensor, setup.start.illuminators,
                                                       setup.backscatter, {}, progress);
    for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
      checks.push_back(compare(found, truth, sensor, i));
  }
  return checks;
}

} // namespace pmdsim
