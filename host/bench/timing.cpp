#include "host/bench/timing.h"

#include "host/capture/exposure.h"

#include <algorithm>
#include <limits>

namespace pmdsim {
namespace {

std::optional<double> larger(const std::optional<double> &a, const std::optional<double> &b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

void add(AccuracyReport &sum, const AccuracyReport &report) {
  sum.precision = std::max(sum.precision, report.precision);
  sum.diodes = std::max(sum.diodes, report.diodes);
  sum.claimed_m = larger(sum.claimed_m, report.claimed_m);
  sum.claimed_amplitude = larger(sum.claimed_amplitude, report.claimed_amplitude);
  sum.found_m = larger(sum.found_m, report.found_m);
  sum.found_amplitude = larger(sum.found_amplitude, report.found_amplitude);
  sum.unpromised += report.unpromised;
  sum.checked_pixels += report.checked_pixels;
  sum.check_ms += report.check_ms;
}

double explained(const TimedFrame &frame) {
  double sum_ms = 0.0;
  for (const PassTime &pass : frame.passes)
    sum_ms += pass.ms;
  return sum_ms / frame.frame_ms;
}

} // namespace

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void add(TimedFrame &sum, const Measurement &measurement) {
  sum.frame_ms += measurement.frame_ms;
  add_passes(sum.passes, measurement.passes);
  if (sum.accuracy)
    add(*sum.accuracy, measurement.accuracy);
  else
    sum.accuracy = measurement.accuracy;
}

double pass_ms(const TimedFrame &frame, std::string_view name) {
  const auto pass = std::ranges::find(frame.passes, name, &PassTime::name);
  return pass == frame.passes.end() ? std::numeric_limits<double>::quiet_NaN() : pass->ms;
}

Timing timing_of(std::span<const TimedFrame> frames) {
  std::vector<double> frames_ms, explains;
  for (const TimedFrame &frame : frames) {
    frames_ms.push_back(frame.frame_ms);
    explains.push_back(explained(frame));
  }
  Timing timing{spread_of(frames_ms), {}, spread_of(explains).median, {}};
  for (const PassTime &pass : frames.front().passes) {
    std::vector<double> times_ms;
    for (const TimedFrame &frame : frames)
      times_ms.push_back(pass_ms(frame, pass.name));
    timing.passes.push_back({pass.name, spread_of(times_ms).median});
  }
  if (frames.back().accuracy)
    timing.accuracy = *frames.back().accuracy;
  return timing;
}

double interactions_per_s(std::span<const TimedFrame> frames, double interactions, Mode mode) {
  const Timing timing = timing_of(frames);
  const auto accumulate = std::ranges::find(timing.passes, "accumulate", &PassTime::name);
  return mode != Mode::exact || accumulate == timing.passes.end() ? std::numeric_limits<double>::quiet_NaN()
                                                                  : interactions / (1e-3 * accumulate->ms);
}

} // namespace pmdsim
