#include "host/commands/timing.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>

namespace pmdsim {
namespace {

void add_passes(std::vector<PassTime> &sum, const std::vector<PassTime> &passes) {
  for (const PassTime &pass : passes) {
    const auto known = std::ranges::find(sum, pass.name, &PassTime::name);
    if (known == sum.end())
      sum.push_back(pass);
    else
      known->ms += pass.ms;
  }
}

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
  sum.checked_pixels += report.checked_pixels;
  sum.check_ms += report.check_ms;
}

} // namespace

Timing time_frames(const std::function<Measurement(const std::string &label)> &measure) {
  std::vector<double> frames_ms;
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> passes_ms;
  Timing timing;
  measure("warming up");
  for (int i = 0; i < measured_frames; ++i) {
    // Only times are kept: frames of the largest sensors would not fit side by side.
    const Measurement measurement = measure(fmt::format("timing {}/{}", i + 1, measured_frames));
    frames_ms.push_back(measurement.frame_ms);
    timing.accuracy = measurement.accuracy;
    for (const PassTime &pass : measurement.passes) {
      if (!passes_ms.contains(pass.name))
        order.push_back(pass.name);
      passes_ms[pass.name].push_back(pass.ms);
    }
  }
  timing.frame_ms = spread_of(frames_ms);
  for (const std::string &name : order)
    timing.passes.push_back({name, spread_of(passes_ms[name]).median});
  return timing;
}

void add(Timing &sum, const Timing &timing) {
  sum.frame_ms.min += timing.frame_ms.min;
  sum.frame_ms.median += timing.frame_ms.median;
  sum.frame_ms.max += timing.frame_ms.max;
  add_passes(sum.passes, timing.passes);
  add(sum.accuracy, timing.accuracy);
}

} // namespace pmdsim
