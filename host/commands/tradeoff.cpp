#include "host/output/tables/tradeoff.h"
#include "host/output/pictures/plots.h"

#include "engine/model/error.h"
#include "host/bench/distance_errors.h"
#include "host/capture/capture.h"
#include "host/capture/progress.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"
#include "host/report/report.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace pmdsim {
namespace {

constexpr std::size_t compared_pixels = 4096;
constexpr std::uint32_t finest_samples = 16; // of the reference that sample counts are compared with
constexpr double reference_slowness = 50.0;  // roughly, of a sample there and on a device
// Times drift on most machines: the points of a sweep are timed in turn, a frame each a round.
constexpr int rounds = 5;
constexpr int frames_of_a_point = 1 + 2 * rounds; // one to be judged, and in each round one to warm up

constexpr std::array<SampleChoice, 5> swept_samples{{{1}, {2}, {4}, {8}, automatic_samples}};
constexpr std::array swept_errors_m{1e-7, 1e-6, 1e-5, 1e-4, 1e-3};

TradeoffPoint point(Sweep sweep, const Accuracy &accuracy, const SampleChoice &choice,
                    std::uint32_t reference_samples) {
  return {.sweep = sweep,
          .accuracy = accuracy,
          .samples = choice.samples,
          .adaptive_samples = choice.adaptive,
          .reference_samples = reference_samples};
}

// The points, none of them measured yet.
std::vector<TradeoffPoint> planned_points(const Sensor &sensor) {
  const SampleChoice own{sensor.samples, sensor.adaptive_samples};
  std::vector<TradeoffPoint> points;
  for (const Precision precision : {Precision::fp32, Precision::fp64})
    points.push_back(point(Sweep::modes, {.mode = Mode::exact, .precision = precision}, own, own.samples));
  for (const Mode mode : {Mode::reduced, Mode::automatic})
    for (const double error_m : swept_errors_m)
      points.push_back(
          point(Sweep::modes, {.mode = mode, .precision = {}, .max_error_m = error_m}, own, own.samples));
  for (const SampleChoice &choice : swept_samples)
    points.push_back(point(Sweep::samples, {}, choice, finest_samples));
  return points;
}

// The work in a device's samples. Modes share the frame that tells where edges are.
double work_of(const std::vector<TradeoffPoint> &points, const Sensor &sensor) {
  const auto samples = [](std::uint64_t pixels, std::uint32_t each) {
    return static_cast<double>(pixels) * each * each;
  };
  double work = 0.0;
  for (const TradeoffPoint &point : points) {
    const bool looks_for_edges = point.sweep == Sweep::samples || &point == &points.front();
    work += (frames_of_a_point + looks_for_edges) * samples(sensor.pixel_count(), point.samples);
  }
  for (const std::uint32_t each : {sensor.samples, finest_samples})
    work +=
        reference_slowness * samples(std::min<std::uint64_t>(sensor.pixel_count(), compared_pixels), each);
  return work;
}

// Measures the points of one sensor, at its only frequency.
class TradeoffSweep {
public:
  TradeoffSweep(const Setup &setup, const Sensor &sensor, const std::string &device)
      : setup_(setup), sensor_(sensor), points_(planned_points(sensor)), camera_(device),
        tagging_camera_(device, {.sample_triangles = true}), bar_(work_of(points_, sensor)) {}

  Tradeoff measure() {
    for (const Sweep sweep : {Sweep::modes, Sweep::samples}) {
      for (TradeoffPoint &point : points_)
        if (point.sweep == sweep)
          judge(point);
      time(sweep);
    }
    mark_pareto(points_);
    return {setup_.file.string(), sensor_.name, camera_.device(), camera_.driver(), points_};
  }

private:
  Sensor with_samples(const SampleChoice &choice) const {
    Sensor sensor = sensor_;
    set_samples(sensor, choice);
    return sensor;
  }

  double samples_of(const Sensor &sensor) const {
    return static_cast<double>(sensor.pixel_count()) * sensor.samples * sensor.samples;
  }

  // Finds the truth that the point is compared with, unless the point before has the same.
  void find_truth(const TradeoffPoint &point) {
    if (!truth_ || truth_->sensor.samples != point.reference_samples) {
      truth_ = true_pixels(point.reference_samples);
      edges_of_samples_ = 0;
    }
    if (edges_of_samples_ == point.samples)
      return;
    const Sensor sensor = with_samples({point.samples});
    tagging_camera_.prepare(setup_, sensor);
    bar_.begin(fmt::format("looking for edges, S = {}", point.samples), samples_of(sensor));
    edges_ = on_edges(*truth_, tagging_camera_.measure(interruptible_progress(bar_)), point.samples,
                      diode_count(setup_.start.illuminators));
    edges_of_samples_ = point.samples;
  }

  TruePixels true_pixels(std::uint32_t samples) {
    TruePixels truth{with_samples({samples}), random_pixels(sensor_.pixel_count(), compared_pixels), {}};
    bar_.begin(fmt::format("measuring the reference, S = {}", samples),
               reference_slowness * static_cast<double>(truth.pixels.size()) * samples * samples);
    truth.frame = reference::simulate(setup_.start.scene, truth.sensor, setup_.start.illuminators,
                                      setup_.backscatter, {.shadows = setup_.shadows, .pixels = truth.pixels},
                                      interruptible_progress(bar_));
    return truth;
  }

  Measurement frame(const TradeoffPoint &point, const Sensor &sensor, const std::string &what) {
    bar_.begin(fmt::format("{}, {}, {}", series_name(point), point_label(point), what), samples_of(sensor));
    return camera_.measure(interruptible_progress(bar_));
  }

  // The point's errors, or why it has none.
  void judge(TradeoffPoint &point) {
    find_truth(point);
    const Sensor sensor = with_samples({point.samples, point.adaptive_samples});
    try {
      camera_.give({.unrounded = true}); // a float's steps would hide what ways to sum differ by
      camera_.prepare(setup_, sensor, point.accuracy);
      const Measurement found = frame(point, sensor, "comparing");
      const ErrorsByPlace errors = distance_errors(*truth_, edges_, found);
      point.smooth = errors.smooth;
      point.edges = errors.edges;
    } catch (const Error &error) {
      if (error.code() != ExitCode::accuracy)
        throw;
      point.refusal = error.what();
    }
  }

  void time(Sweep sweep) {
    std::vector<std::vector<double>> frames_ms(points_.size());
    camera_.give({});
    for (int round = 1; round <= rounds; ++round)
      for (std::size_t i = 0; i < points_.size(); ++i) {
        TradeoffPoint &point = points_[i];
        if (point.sweep != sweep || !point.refusal.empty())
          continue;
        const Sensor sensor = with_samples({point.samples, point.adaptive_samples});
        camera_.prepare(setup_, sensor, point.accuracy);
        frame(point, sensor, fmt::format("warming up {}/{}", round, rounds));
        const Measurement timed = frame(point, sensor, fmt::format("timing {}/{}", round, rounds));
        frames_ms[i].push_back(timed.frame_ms);
        point.report = timed.accuracy;
      }
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (!frames_ms[i].empty()) {
        const Spread spread = spread_of(frames_ms[i]);
        points_[i].time = {spread.median, spread.min, spread.max};
      }
  }

  const Setup &setup_;
  Sensor sensor_;
  std::vector<TradeoffPoint> points_;
  Camera camera_, tagging_camera_;
  ProgressBar bar_;
  std::optional<TruePixels> truth_;
  std::vector<bool> edges_;
  std::uint32_t edges_of_samples_ = 0; // S of the frame that they were found in
};

std::vector<std::string> write_files(OutputSet &files, const Tradeoff &tradeoff) {
  const auto add = [&](const std::string &name, const auto &write) {
    throw_if_interrupted();
    files.add(name, write);
  };
  add("tradeoff.csv", [&](OutputFile &file) { file.write(tradeoff_csv(tradeoff)); });
  add("tradeoff.json", [&](OutputFile &file) { file.write(json_text(tradeoff_json(tradeoff))); });
  add("tradeoff.md", [&](OutputFile &file) { file.write(tradeoff_markdown(tradeoff)); });
  add("tradeoff.png", [&](OutputFile &file) { draw_tradeoff(tradeoff).write_png(file); });
  throw_if_interrupted();
  files.publish();
  return files.paths();
}

} // namespace

void run_tradeoff(const Options &options) {
  Setup setup = requested_setup_without_bounces(options.capture);
  leave_out_electronics(setup);
  OutputSet files(options.capture.output_directory); // first, so that nothing is measured in vain
  Sensor sensor = setup.start.sensors.front();
  sensor.modulation_hz.resize(1);
  const Tradeoff tradeoff = TradeoffSweep(setup, sensor, options.capture.device).measure();
  const std::vector<std::string> paths = write_files(files, tradeoff);
  if (options.json) {
    nlohmann::ordered_json json = tradeoff_json(tradeoff);
    json["outputs"] = paths;
    print(json_text(json));
  } else {
    print(fmt::format("device  {} ({})\n\n{}\nwritten:\n  {}\n", tradeoff.device, tradeoff.driver,
                      tradeoff_text(tradeoff), fmt::join(paths, "\n  ")));
  }
}

} // namespace pmdsim
