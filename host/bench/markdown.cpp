#include "host/bench/ratios.h"
#include "host/bench/results.h"
#include "host/output/files/accuracy_record.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace pmdsim {
namespace {

std::string row_text(const std::vector<std::string> &cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string head_text(const std::vector<std::string> &cells) {
  return row_text(cells) + row_text(std::vector<std::string>(cells.size(), "---"));
}

std::string number(double value, int digits = 4) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}g}", value, digits);
}

std::string ms_text(double ms) { return std::isnan(ms) ? "-" : fmt::format("{:.{}f}", ms, ms < 100 ? 2 : 0); }

std::string from_to(const Spread &spread, const auto &text) {
  return fmt::format("{} to {}", text(spread.min), text(spread.max));
}

std::string mebibytes(const std::optional<std::int64_t> &bytes) {
  return bytes ? fmt::format("{:.0f}", static_cast<double>(*bytes) / (1 << 20)) : "-";
}

std::string machine_text(const BenchReport &report) {
  const Machine &machine = report.machine;
  std::string text =
      fmt::format("    {}\n\nDevice: {} ({}). Processor: {}, {} threads, {} of them used. "
                  "Program: pmdsim {}, {}, {}. Pass times by {}.",
                  report.command, machine.device, machine.driver, machine.processor, machine.hardware_threads,
                  machine.threads, machine.version, machine.compiler, machine.build,
                  machine.passes_by == "clock" ? "the clock" : "the device's timestamps");
  std::vector<std::string> set;
  for (const auto &[name, value] : machine.environment.items())
    if (!value.is_null())
      set.push_back(fmt::format("{}={}", name, value.get<std::string>()));
  return text + fmt::format(" Environment: {}. Samples a pixel: {}.\n",
                            set.empty() ? "nothing set" : fmt::format("{}", fmt::join(set, " ")),
                            fmt::join(report.samples, ", "));
}

std::string error_text(const AccuracyCheck &check, Mode mode) {
  const std::string what = fmt::format("- mode {}, sensor {} at {}: ", mode_name(mode), check.sensor,
                                       frequency_text(check.modulation_hz));
  if (check.comparable == 0)
    return what + "nothing to compare, the reference is dark in every pixel\n";
  if (check.pixels == 0)
    return what + "nothing to compare, rounding decides about the light of every pixel\n";
  return what + fmt::format("off the reference by at most {} over {} pixels of {} x {}\n",
                            micrometres_text(check.distance_max_m), check.pixels, check.resolution.x,
                            check.resolution.y);
}

std::string modes_text(const SetupBench &bench) {
  std::string text =
      head_text({bench.name, "frame, ms", "least to most", "frames/s", "interactions/s in accumulate",
                 "passes / frame", "first frame, ms", "prepare, ms", "sum"});
  for (const ModeBench &mode : bench.modes) {
    const Timing timing = timing_of(mode.frames);
    text += row_text(
        {mode_name(mode.mode), ms_text(timing.frame_ms.median), from_to(timing.frame_ms, ms_text),
         number(1e3 / timing.frame_ms.median), number(spread_of(interactions_per_s(bench, mode)).median),
         fmt::format("{:.3f}", timing.passes_explain), ms_text(mode.first_frame_ms),
         mode.prepare_ms ? ms_text(*mode.prepare_ms) : "-", sum_text(mode.mode, timing.accuracy)});
  }
  return text;
}

// A column each mode, a row each pass that any of them has.
std::string passes_text(const SetupBench &bench) {
  std::vector<std::string> head{"pass, ms"}, names;
  std::vector<Timing> timings;
  for (const ModeBench &mode : bench.modes) {
    head.push_back(mode_name(mode.mode));
    timings.push_back(timing_of(mode.frames));
    for (const PassTime &pass : timings.back().passes)
      if (std::ranges::find(names, pass.name) == names.end())
        names.push_back(pass.name);
  }
  if (names.empty())
    return "";
  std::string text = "\n" + head_text(head);
  for (const std::string &name : names) {
    std::vector<std::string> cells{name};
    for (const Timing &timing : timings) {
      const auto pass = std::ranges::find(timing.passes, name, &PassTime::name);
      cells.push_back(pass == timing.passes.end() ? "-" : fmt::format("{:.3f}", pass->ms));
    }
    text += row_text(cells);
  }
  return text;
}

std::string native_text(const NativeBench &native) {
  const CheckedKernel &checked = native.checked();
  const NativeKernel &kernel = checked.kernel;
  const auto rate = [](double value) { return fmt::format("{:.3g}", value); };
  const auto row = [&](const std::string &name, const std::vector<double> &rates, double error_m) {
    const Spread spread = spread_of(rates);
    return row_text({name, rate(spread.median), from_to(spread, rate), micrometres_text(error_m)});
  };
  std::string text =
      fmt::format("\nNative kernel: {}, {} threads, {} points x {} diodes, {}.\n\n", kernel.instructions(),
                  kernel.threads(), kernel.points(), kernel.diodes(), checked.points) +
      head_text({"native kernel", "interactions/s", "least to most", "off double by"}) +
      row("moments", native.moments_per_s(), checked.moments_error_m);
  if (checked.series_error_m)
    text += row(fmt::format("series, {} powers", kernel.series_powers()), native.series_per_s(),
                *checked.series_error_m);
  return text;
}

std::string ratios_text(const SetupBench &bench) {
  const std::vector<Ratio> ratios = ratios_of(bench);
  if (ratios.empty())
    return "";
  const auto digits = [](double value) { return fmt::format("{:.3g}", value); };
  std::string text = "\n" + head_text({"ratio", "of medians", "within a round"});
  for (const Ratio &ratio : ratios)
    text += row_text({ratio.name, digits(ratio.value), from_to(ratio.of_rounds, digits)});
  return text;
}

std::string setup_text(const SetupBench &bench) {
  const std::string sensors = bench.sensors > 1 ? fmt::format(" of each of {} sensors", bench.sensors) : "";
  std::string text =
      fmt::format("\nMedians of {} warm frames{}, modes and native kernel in turn. Peak memory {} MiB.\n\n",
                  bench_rounds, sensors, mebibytes(bench.peak_memory_bytes)) +
      modes_text(bench) + "\n";
  for (const ModeBench &mode : bench.modes) {
    for (const AccuracyCheck &check : mode.checks)
      text += error_text(check, mode.mode);
    if (const std::string errors = errors_text(timing_of(mode.frames).accuracy); !errors.empty())
      text += fmt::format("- mode {}: {}\n", mode_name(mode.mode), errors);
  }
  text += passes_text(bench);
  if (bench.native)
    text += native_text(*bench.native);
  return text + ratios_text(bench);
}

std::string sequence_text(const SequenceRate &rate, Mode mode) {
  return fmt::format("\nA sequence of {} frames in mode {}, frames/s by the clock.\n\n", rate.frames,
                     mode_name(mode)) +
         head_text({"not written", "as NPY", "as EXR"}) +
         row_text({number(rate.measured_per_s), number(rate.npy_per_s), number(rate.exr_per_s)});
}

std::string pass_cell(const Timing &timing, const std::string &name) {
  const auto pass = std::ranges::find(timing.passes, name, &PassTime::name);
  return pass == timing.passes.end() ? "-" : ms_text(pass->ms);
}

std::string sweep_text(const std::vector<SweepRow> &rows, Mode mode) {
  const std::vector<std::string> passes{"visibility", "points", "accumulate", "resolve", "read_back"};
  std::vector<std::string> head{"sweep", "frame, ms", "least to most", "interactions/s"};
  head.insert(head.end(), passes.begin(), passes.end());
  head.insert(head.end(), {"passes / frame", "error, µm", "first frame, ms", "prepare, ms", "peak, MiB"});
  std::string text =
      fmt::format("\nOne quantity at a time, mode {}; passes in ms.\n\n", mode_name(mode)) + head_text(head);
  for (const SweepRow &row : rows) {
    const Timing timing = timing_of(row.frames);
    std::vector<std::string> cells{row.point.name(), ms_text(timing.frame_ms.median),
                                   from_to(timing.frame_ms, ms_text),
                                   number(interactions_per_s(row, mode), 3)};
    for (const std::string &pass : passes)
      cells.push_back(pass_cell(timing, pass));
    cells.insert(cells.end(),
                 {fmt::format("{:.3f}", timing.passes_explain), number(1e6 * row.error_m, 3),
                  ms_text(row.first_frame_ms), ms_text(row.prepare_ms), mebibytes(row.peak_memory_bytes)});
    text += row_text(cells);
  }
  return text;
}

std::string growth_text(const Growth &growth) {
  const std::string unit = unit_name(growth.quantity);
  std::string text =
      fmt::format("\nMedian frame time over {}: {} ms + {} ms each.\n\n", unit, number(growth.line.fixed_ms),
                  number(growth.line.slope_ms)) +
      head_text({unit, "frame, ms", "over the line", "each more since the row before, ms", "over the slope"});
  for (std::size_t i = 0; i < growth.points.size(); ++i) {
    const auto &[size, ms] = growth.points[i];
    const double marginal_ms = growth.marginal_ms[i];
    text += row_text({fmt::format("{:.0f}", size), ms_text(ms),
                      fmt::format("{:+.1f} %", 100.0 * (ms / growth.line.at_ms(size) - 1.0)),
                      number(marginal_ms), number(marginal_ms / growth.line.slope_ms, 3)});
  }
  return text;
}

} // namespace

std::string bench_markdown(const BenchReport &report) {
  std::string text = machine_text(report) + setup_text(report.setup);
  if (report.sequence)
    text += sequence_text(*report.sequence, report.options.accuracy.mode);
  if (!report.sweep.empty())
    text += sweep_text(report.sweep, report.options.accuracy.mode);
  for (const Growth &growth : growths_of(report.sweep))
    text += growth_text(growth);
  return text;
}

} // namespace pmdsim
