#include "engine/model/error.h"
#include "host/bench/real/scene_files.h"
#include "host/bench/results.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string>
#include <vector>

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

// Those asked for; all but the awkward ones where none are.
std::vector<SceneKind> kinds_of(const SuiteOptions &suite) {
  std::vector<SceneKind> kinds;
  for (const std::string &name : suite.kinds) {
    const SceneKind *kind = find_kind(name);
    if (!kind)
      throw Error(ExitCode::usage, fmt::format("--kinds: there is no kind of scene {}", name));
    kinds.push_back(*kind);
  }
  if (kinds.empty())
    std::ranges::copy_if(scene_kinds(), std::back_inserter(kinds),
                         [](const SceneKind &kind) { return !kind.awkward; });
  return kinds;
}

void run_suite(const SuiteOptions &suite) {
  for (const SceneKind &kind : kinds_of(suite)) {
    const Setup setup = setup_of_kind(kind, suite.triangles, suite.columns);
    print(fmt::format(
        "{}: {} triangles\n",
        write_scene_files(suite.directory, fmt::format("{}_{}", kind.name, suite.triangles), setup)
            .setup.string(),
        setup.start.scene.triangles.size()));
  }
}

} // namespace

void run_bench(const Options &options) {
  if (options.suite)
    return run_suite(*options.suite);
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
