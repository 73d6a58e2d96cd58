#include "host/bench/ratios.h"

#include "host/output/files/accuracy_record.h"

#include <fmt/format.h>
#include <span>

namespace pmdsim {
namespace {

// `over` / `under`, both of the same rounds.
Ratio ratio(std::string name, std::span<const double> over, std::span<const double> under) {
  std::vector<double> of_rounds;
  for (std::size_t i = 0; i < over.size(); ++i)
    of_rounds.push_back(over[i] / under[i]);
  return {std::move(name), spread_of(over).median / spread_of(under).median, spread_of(of_rounds)};
}

std::vector<double> frames_ms(const ModeBench &mode) {
  std::vector<double> times_ms;
  for (const TimedFrame &frame : mode.frames)
    times_ms.push_back(frame.frame_ms);
  return times_ms;
}

} // namespace

std::vector<Ratio> ratios_of(const SetupBench &bench) {
  std::vector<Ratio> ratios;
  if (bench.modes.empty() || bench.modes.front().mode != Mode::exact)
    return ratios;
  const ModeBench &exact = bench.modes.front();
  const std::vector<double> accumulate = interactions_per_s(bench, exact);
  if (bench.native && !accumulate.empty()) {
    ratios.push_back(ratio("accumulate_over_native", accumulate, bench.native->moments_per_s()));
    if (!bench.native->series_per_s().empty())
      ratios.push_back(ratio("accumulate_over_native_series", accumulate, bench.native->series_per_s()));
  }
  for (const ModeBench &mode : bench.modes)
    if (mode.mode != Mode::exact)
      ratios.push_back(ratio(fmt::format("exact_frame_over_{}_frame", mode_name(mode.mode)), frames_ms(exact),
                             frames_ms(mode)));
  return ratios;
}

} // namespace pmdsim
