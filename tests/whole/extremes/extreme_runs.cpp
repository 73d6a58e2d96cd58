#include "tests/whole/extremes/extreme_runs.h"

#include "engine/model/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pmdsim::test {

namespace {

bool sees_the_same(const Measurement &measured, const reference::Frame &expected, std::uint32_t samples,
                   std::size_t pixel) {
  const std::size_t columns = expected.resolution.x, row_samples = columns * samples;
  const std::size_t first = pixel / columns * samples * row_samples + pixel % columns * samples;
  for (std::uint32_t row = 0; row < samples; ++row)
    for (std::uint32_t column = 0; column < samples; ++column) {
      const std::size_t sample = first + row * row_samples + column;
      if (measured.sample_triangle_id[sample] != expected.sample_triangle_id[sample])
        return false;
    }
  return true;
}

// Whether the values of a pixel that light returns to are possible.
bool is_possible(const Return &measured, double ambiguity_m, std::size_t pixel) {
  const auto within = [](float value, double end) {
    return value >= 0.0f && static_cast<double>(value) < end;
  };
  return measured.amplitude[pixel] > 0.0f && std::isfinite(measured.amplitude[pixel]) &&
         within(measured.phase_rad[pixel], 2.0 * std::numbers::pi) &&
         within(measured.distance_m[pixel], ambiguity_m);
}

// As docs/theory.md, "The measurement", has it where |z| = 0.
bool is_dark(const Return &measured, std::size_t pixel) {
  return measured.amplitude[pixel] == 0.0f && std::isnan(measured.phase_rad[pixel]) &&
         std::isnan(measured.distance_m[pixel]);
}

// Without a bound of the error nothing may be left of a return of which the limit leaves nothing.
bool may_be_dark(const ExtremeTruth &truth, const Accuracy &accuracy, std::size_t pixel) {
  const bool is_bounded = accuracy.mode == Mode::automatic;
  return !truth.is_known(pixel) || (!is_bounded && truth.limit_m(pixel) >= 0.5 * truth.ambiguity_m());
}

void compare_pixel(ExtremeRun &run, const Return &measured, const ExtremeTruth &truth, std::size_t pixel) {
  const reference::FrameReturn &expected = truth.frame().returns[0];
  const double error_m =
      std::abs(std::remainder(measured.distance_m[pixel] - expected.distance_m[pixel], expected.ambiguity_m));
  ++run.pixels;
  run.error_m = std::max(run.error_m, error_m);
  run.error_over_limit = std::max(run.error_over_limit, error_m / truth.limit_m(pixel));
  run.amplitude_error =
      std::max(run.amplitude_error, std::abs(measured.amplitude[pixel] / expected.amplitude[pixel] - 1.0));
}

void compare(ExtremeRun &run, const Measurement &measured, const ExtremeTruth &truth,
             const Accuracy &accuracy) {
  for (std::size_t pixel = 0; pixel < truth.frame().range_m.size(); ++pixel)
    if (!sees_the_same(measured, truth.frame(), truth.setup().sensor.samples, pixel))
      ++run.differing;
    else if (is_dark(measured.returns[0], pixel) && may_be_dark(truth, accuracy, pixel))
      continue;
    else if (!is_possible(measured.returns[0], truth.ambiguity_m(), pixel))
      ++run.impossible;
    else if (truth.is_known(pixel))
      compare_pixel(run, measured.returns[0], truth, pixel);
}

} // namespace

ExtremeTruth::ExtremeTruth(const ExtremeSetup &setup)
    : built_(build(setup)),
      frame_(reference::simulate(built_.scene, built_.sensor, built_.illuminators, Backscatter::lambert)) {}

double ExtremeTruth::limit_m(std::size_t pixel) const {
  const double distance_m = std::max(frame_.range_m[pixel], frame_.returns[0].distance_m[pixel]);
  return condition(pixel) * std::min(std::max(1e-6, 1.2e-7 * distance_m), 1e-3 * ambiguity_m());
}

bool ExtremeTruth::is_known(std::size_t pixel) const {
  if (!(frame_.returns[0].amplitude[pixel] > 0))
    return false;
  // The rounding of a path's phase is that of the sine and that of the path's length in turns.
  const double rounding_turns = (1.0 + frame_.range_m[pixel] / ambiguity_m()) * 0x1p-52;
  return condition(pixel) * rounding_turns * ambiguity_m() < 0.1e-6;
}

double ExtremeTruth::smallest_limit_m() const {
  double smallest_m = 1e-3 * ambiguity_m();
  for (std::size_t pixel = 0; pixel < frame_.range_m.size(); ++pixel)
    if (is_known(pixel))
      smallest_m = std::min(smallest_m, limit_m(pixel));
  return smallest_m;
}

double ExtremeTruth::largest_condition() const {
  double largest = 0.0;
  for (std::size_t pixel = 0; pixel < frame_.range_m.size(); ++pixel)
    if (is_known(pixel))
      largest = std::max(largest, condition(pixel));
  return largest;
}

ExtremeRun run(Simulator &simulator, const ExtremeTruth &truth, const Accuracy &accuracy) {
  ExtremeRun run;
  Measurement measured;
  const auto &[scene, sensor, illuminators] = truth.setup();
  try {
    simulator.prepare(scene, sensor, illuminators, Backscatter::lambert, Shadows::off, accuracy);
    measured = simulator.measure();
  } catch (const Error &error) {
    run.refusal = error.what();
    run.refused_rightly = error.code() == ExitCode::accuracy || error.code() == ExitCode::input;
    return run;
  }
  run.accuracy = measured.accuracy;
  compare(run, measured, truth, accuracy);
  return run;
}

} // namespace pmdsim::test
