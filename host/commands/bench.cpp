#include "engine/model/error.h"
#include "host/bench/real/scene_files.h"
#include "host/bench/results.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <iterator>
#include <optional>
#include <span>
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

std::vector<std::string> names_of(std::span<const SceneKind> kinds) {
  std::vector<std::string> names;
  for (const SceneKind &kind : kinds)
    names.emplace_back(kind.name);
  return names;
}

// Those asked for; all but the awkward ones where none are.
std::vector<SceneKind> kinds_of(const SuiteOptions &suite) {
  std::vector<SceneKind> kinds;
  for (const std::string &name : suite.kinds) {
    const SceneKind *kind = find_kind(name);
    if (!kind)
      throw Error(ExitCode::usage, fmt::format("--kinds: expected some of {}; found {}",
                                               fmt::join(names_of(scene_kinds()), ", "), name));
    kinds.push_back(*kind);
  }
  if (kinds.empty())
    std::ranges::copy_if(scene_kinds(), std::back_inserter(kinds),
                         [](const SceneKind &kind) { return !kind.awkward; });
  return kinds;
}

void write_scenes(const SuiteScenes &scenes, const std::filesystem::path &directory) {
  for (const SceneKind &kind : scenes.kinds) {
    const Setup setup = setup_of_kind(kind, scenes.triangles, scenes.columns);
    const SceneFiles files =
        write_scene_files(directory, fmt::format("{}_{}", kind.name, scenes.triangles), setup);
    print(fmt::format("{}: {} triangles\n", files.setup.string(), setup.start.scene.triangles.size()));
  }
}

BenchReport bench_suite(const Options &options, const BenchRequest &request) {
  const SuiteOptions &suite = *options.suite;
  BenchReport report{.command = "pmdsim bench --suite real",
                     .request = request,
                     .machine = this_machine(Camera(request.device)),
                     .samples = {"1 x 1"}};
  std::optional<Peer> peer;
  if (!suite.peer.empty())
    peer = {suite.peer, report.machine.threads};
  report.suite = run_suite({kinds_of(suite), suite.triangles, suite.columns}, request, peer);
  return report;
}

BenchReport bench_of_setup(const Options &options, const BenchRequest &request) {
  const bool swept = options.capture.setup.empty();
  const Setup setup = swept ? paper_ring() : requested_setup_without_bounces(options.capture);
  BenchReport report{.command = swept ? "pmdsim bench" : "pmdsim bench " + options.capture.setup.string(),
                     .request = request,
                     .machine = this_machine(Camera(request.device)),
                     .samples = samples_of(setup),
                     .setup = bench_setup(setup, request, swept ? "paper_ring" : "setup")};
  if (swept) {
    report.sequence = measure_sequence_rate(setup, request, sequence_frames);
    report.sweep = run_sweep(all_sweeps(), request);
  }
  return report;
}

} // namespace

void run_bench(const Options &options) {
  if (options.suite && !options.suite->directory.empty())
    return write_scenes({kinds_of(*options.suite), options.suite->triangles, options.suite->columns},
                        options.suite->directory);
  const BenchRequest request{options.capture.device, options.capture.accuracy, options.mode_written};
  const BenchReport report = options.suite ? bench_suite(options, request) : bench_of_setup(options, request);
  print(options.json ? json_text(bench_json(report)) : bench_markdown(report));
}

} // namespace pmdsim
