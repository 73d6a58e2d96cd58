#include "host/bench/modes.h"

#include "engine/model/error.h"
#include "host/bench/machine.h"
#include "host/capture/exposure.h"
#include "host/capture/progress.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace pmdsim {
namespace {

constexpr int prepared_times = 3;

// The accumulate pass where it loops over the diodes, in mode exact, of the first sensor.
class LoopedSum {
public:
  LoopedSum(const Setup &setup, const BenchRequest &request)
      : camera_(request.device, {.diodes_in_a_loop = true}) {
    const Sensor &sensor = setup.start.sensors.front();
    Accuracy accuracy = request.accuracy;
    accuracy.mode = Mode::exact;
    camera_.prepare(setup, sensor, accuracy);
    interactions_ = static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples *
                    static_cast<double>(diode_count(setup.start.illuminators));
    camera_.reuse(camera_.measure());
  }

  double interactions_per_s() {
    TimedFrame frame;
    Measurement measurement = camera_.measure();
    add(frame, measurement);
    camera_.reuse(std::move(measurement));
    return interactions_ / (1e-3 * pass_ms(frame, "accumulate"));
  }

private:
  Camera camera_;
  double interactions_;
};

// Measures one setup in several modes, which it adds to `bench`.
class ModesInTurn {
public:
  ModesInTurn(const Setup &setup, const BenchRequest &request, SetupBench &bench)
      : setup_(setup), request_(request), bench_(bench),
        bar_((1 + (several_sensors() ? 2 : 1) * bench_rounds) * 3.0 * samples_of_frame(setup)) {}

  // With its first frame taken and its results checked.
  void open(Mode mode, const std::vector<ReferenceFrame> &truth) {
    Accuracy accuracy = request_.accuracy;
    accuracy.mode = mode;
    ModeBench bench{.mode = mode, .prepare_ms = {}, .checks = {}, .frames = {}};
    auto exposures = std::make_unique<Exposures>(setup_, request_.device, false, accuracy);
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t sensor = 0; sensor < setup_.start.sensors.size(); ++sensor)
      exposures->reuse(take(*exposures, sensor, mode, "first frame"));
    bench.first_frame_ms = ms_since(start);
    bench.path = exposures->camera().path();
    bench.checks = check_accuracy(setup_, truth, request_.device, accuracy);
    for (const AccuracyCheck &check : bench.checks)
      require_plausible(check, fmt::format("{}, mode {}", exposures->camera().device(), mode_name(mode)));
    if (!exposures->camera().is_reference())
      bench.prepare_ms = prepare_ms(accuracy);
    bench_.modes.push_back(std::move(bench));
    exposures_.push_back(std::move(exposures));
  }

  void time_round(int round) {
    for (std::size_t i = 0; i < exposures_.size(); ++i) {
      ModeBench &mode = bench_.modes[i];
      mode.frames.push_back(
          take(*exposures_[i], mode.mode, fmt::format("timing {}/{}", round, bench_rounds)));
      if (i == 0 && bench_.native) {
        if (!looped_)
          looped_.emplace(setup_, request_);
        bench_.looped_per_s.push_back(looped_->interactions_per_s());
        bench_.native->run();
      }
    }
  }

private:
  bool several_sensors() const { return setup_.start.sensors.size() > 1; }

  // A frame of every sensor. Where several share the device each comes to it cold, and its second frame
  // counts.
  TimedFrame take(Exposures &exposures, Mode mode, const std::string &what) {
    TimedFrame sum;
    for (std::size_t sensor = 0; sensor < setup_.start.sensors.size(); ++sensor) {
      if (several_sensors())
        exposures.reuse(take(exposures, sensor, mode, "warming up"));
      Measurement frame = take(exposures, sensor, mode, what);
      add(sum, frame);
      exposures.reuse(std::move(frame));
    }
    return sum;
  }

  Measurement take(Exposures &exposures, std::size_t sensor, Mode mode, const std::string &what) {
    bar_.begin(fmt::format("mode {}, {}", mode_name(mode), what),
               samples_of_frame(setup_, setup_.start.sensors[sensor]));
    return exposures.take(sensor, 0, Light::beside_lens, interruptible_progress(bar_)).measurement;
  }

  double prepare_ms(const Accuracy &accuracy) const {
    Camera camera(request_.device);
    double sum_ms = 0.0;
    for (const Sensor &sensor : setup_.start.sensors) {
      std::vector<double> times_ms;
      for (int i = 0; i <= prepared_times; ++i) {
        const auto start = std::chrono::steady_clock::now();
        camera.prepare(setup_, sensor, accuracy);
        if (i > 0)
          times_ms.push_back(ms_since(start));
      }
      sum_ms += spread_of(times_ms).median;
    }
    return sum_ms;
  }

  const Setup &setup_;
  const BenchRequest &request_;
  SetupBench &bench_;
  ProgressBar bar_;
  std::optional<LoopedSum> looped_;
  std::vector<std::unique_ptr<Exposures>> exposures_; // beside the bench's modes
};

// The one that is asked for, else all that there are.
std::vector<Mode> modes_of(const BenchRequest &request, const Setup &setup) {
  if (request.one_mode)
    return {request.accuracy.mode};
  const bool only_exact = names_the_reference(request.device) || exposes_any_tap_by_tap(setup);
  return only_exact ? std::vector{Mode::exact} : std::vector{Mode::exact, Mode::reduced, Mode::automatic};
}

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

SetupBench bench_setup(const Setup &setup, const BenchRequest &request, const std::string &name) {
  const std::vector<Sensor> &sensors = setup.start.sensors;
  const bool on_reference = names_the_reference(request.device);
  SetupBench bench;
  bench.name = name;
  bench.interactions = samples_of_frame(setup) * static_cast<double>(diode_count(setup.start.illuminators));
  bench.adaptive = std::ranges::any_of(sensors, &Sensor::adaptive_samples);
  bench.sensors = static_cast<std::uint32_t>(sensors.size());
  ModesInTurn turns(setup, request, bench);
  const std::vector<ReferenceFrame> truth =
      on_reference ? std::vector<ReferenceFrame>() : reference_frames(setup);
  const std::vector<Mode> modes = modes_of(request, setup);
  for (const Mode mode : modes) {
    try {
      turns.open(mode, truth);
    } catch (const Error &error) {
      if (request.one_mode || error.code() != ExitCode::accuracy)
        throw;
      warn({warning_code("mode-left-out"), setup.file.string(),
            fmt::format("mode {} is left out: {}", mode_name(mode), error.what())});
    }
  }
  if (modes.front() == Mode::exact && !bench.adaptive && !on_reference)
    bench.native = native_bench(setup, request.device); // beside the first mode
  for (int round = 1; round <= bench_rounds; ++round)
    turns.time_round(round);
  bench.peak_memory_bytes = peak_memory_bytes();
  return bench;
}

std::vector<double> interactions_per_s(const SetupBench &bench, const ModeBench &mode) {
  std::vector<double> rates;
  if (mode.mode == Mode::exact && !bench.adaptive)
    for (const TimedFrame &frame : mode.frames)
      if (const double accumulate_ms = pass_ms(frame, "accumulate"); !std::isnan(accumulate_ms))
        rates.push_back(bench.interactions / (1e-3 * accumulate_ms));
  return rates;
}

std::vector<Ratio> ratios_of(const SetupBench &bench) {
  std::vector<Ratio> ratios;
  if (bench.modes.empty() || bench.modes.front().mode != Mode::exact)
    return ratios;
  const ModeBench &exact = bench.modes.front();
  if (bench.native && !bench.looped_per_s.empty()) {
    ratios.push_back(ratio("accumulate_over_native", bench.looped_per_s, bench.native->moments_per_s));
    if (!bench.native->series_per_s.empty())
      ratios.push_back(
          ratio("accumulate_over_native_series", bench.looped_per_s, bench.native->series_per_s));
  }
  for (const ModeBench &mode : bench.modes)
    if (mode.mode != Mode::exact)
      ratios.push_back(ratio(fmt::format("exact_frame_over_{}_frame", mode_name(mode.mode)), frames_ms(exact),
                             frames_ms(mode)));
  return ratios;
}

} // namespace pmdsim
