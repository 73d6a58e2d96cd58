#include "host/bench/results.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::uint32_t sequence_frames = 100;

std::vector<std::string> samples_of(const Setup &setup) {
  std::vector<std::string> samples;
  for (const Sensor &sensor : setup.start.sensors)
    samples.push_back(sensor.adaptive_samples ? "auto"
                                              : fmt::format("{} x {}", sensor.samples, sensor.samples));
  return samples;
}

} // namespace

void run_bench(const Options &options) {
  const bool swept = options.capture.setup.empty();
  const Setup setup = swept ? paper_ring() : requested_setup(options.capture);
  const BenchRequest request{options.capture.device, options.capture.accuracy, options.mode_written};
  BenchReport report{.command = swept ? "pmdsim bench" : "pmdsim bench " + options.capture.setup.string(),
                     .request = request,
                     .machine = this_machine(Camera(request.device)),
                     .samples = samples_of(setup),
                     .setup = bench_setup(setup, request, swept ? "paper_ring" : "setup")};
  if (swept) {
    report.sequence = measure_sequence_rate(setup, request, sequence_frames);
    report.sweep = run_sweep(all_sweeps(), request);
  }
  print(options.json ? json_text(bench_json(report)) : bench_markdown(report));
}

} // namespace pmdsim
