#include "host/bench/sweep.h"

#include "engine/model/error.h"
#include "host/bench/distance_errors.h"
#include "host/bench/machine.h"
#include "host/capture/exposure.h"
#include "host/capture/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {
namespace {

constexpr double checked_interactions = 1e7; // a second of the reference
constexpr std::size_t fewest_checked = 32, most_checked = 1024;
constexpr int sweep_rounds = 9;
constexpr double visit_ms = 60.0; // frames are timed until they have taken this
constexpr int most_frames_of_visit = 4;

// The time of a frame, roughly; for the progress bar.
double expected_s(const Setup &setup) {
  const auto diodes = static_cast<double>(diode_count(setup.start.illuminators));
  return 0.02 + samples_of_frame(setup) * (50e-9 + 0.3e-9 * diodes);
}

// The time of all that is done with a point.
double expected_s(const SweepPoint &point) {
  const double frame_s = expected_s(swept_setup(point));
  const double warm = std::clamp(1e-3 * visit_ms / frame_s, 1.0, double{most_frames_of_visit});
  return frame_s * (1.0 + sweep_rounds * (1.0 + warm));
}

// The points of one quantity, a visit each in every round, as a machine's clock drifts.
class PointsInTurn {
public:
  PointsInTurn(const std::vector<SweepPoint> &points, const BenchRequest &request) : request_(request) {
    for (const SweepPoint &point : points) {
      setups_.push_back(swept_setup(point));
      rows_.push_back({.point = point, .peak_memory_bytes = {}, .frames = {}});
    }
  }

  std::vector<SweepRow> measure(ProgressBar &bar) {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      begin(i, bar);
    for (int round = 1; round <= sweep_rounds; ++round)
      for (std::size_t i = 0; i < rows_.size(); ++i)
        visit(i, round, bar);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i].prepare_ms = spread_of(prepares_ms_[i]).median;
    return std::move(rows_);
  }

private:
  // The time that it takes.
  double prepare(std::size_t i) {
    const auto start = std::chrono::steady_clock::now();
    camera_->prepare(setups_[i], setups_[i].start.sensors.front(), request_.accuracy);
    return ms_since(start);
  }

  Measurement frame(std::size_t i, const std::string &what, ProgressBar &bar) {
    bar.begin(fmt::format("{}, {}", rows_[i].point.name(), what), expected_s(setups_[i]));
    return camera_->measure(interruptible_progress(bar));
  }

  // The first frame, with its result checked.
  void begin(std::size_t i, ProgressBar &bar) {
    SweepRow &row = rows_[i];
    row.interactions =
        samples_of_frame(setups_[i]) * static_cast<double>(diode_count(setups_[i].start.illuminators));
    camera_.reset(); // with all that the point before left on the device
    restart_peak_memory();
    camera_.emplace(request_.device);
    const auto start = std::chrono::steady_clock::now();
    prepare(i);
    const Measurement first = frame(i, "first frame", bar);
    row.first_frame_ms = ms_since(start);
    row.peak_memory_bytes = peak_memory_bytes();
    prepares_ms_.emplace_back();
    bar.begin(row.point.name() + ", checking", 0.0);
    const auto [error_m, pixels] = check_at_random(setups_[i], first, camera_->device());
    row.error_m = error_m;
    row.checked_pixels = pixels;
  }

  void visit(std::size_t i, int round, ProgressBar &bar) {
    prepares_ms_[i].push_back(prepare(i));
    const std::string what = fmt::format("timing {}/{}", round, sweep_rounds);
    camera_->reuse(frame(i, what, bar)); // the first is cold
    double spent_ms = 0.0;
    for (int k = 0; k < most_frames_of_visit && spent_ms < visit_ms; ++k) {
      Measurement measured = frame(i, what, bar);
      TimedFrame timed;
      add(timed, measured);
      camera_->reuse(std::move(measured));
      spent_ms += timed.frame_ms;
      rows_[i].frames.push_back(std::move(timed));
    }
  }

  const BenchRequest &request_;
  std::optional<Camera> camera_;
  std::vector<Setup> setups_;
  std::vector<SweepRow> rows_;
  std::vector<std::vector<double>> prepares_ms_; // beside the rows
};

} // namespace

StraightLine straight_line(std::span<const SizeAndTime> points) {
  // The normal equations of fixed a + slope b = 1 with a = 1 / ms and b = size / ms.
  double aa = 0.0, ab = 0.0, bb = 0.0, a = 0.0, b = 0.0;
  for (const auto &[size, ms] : points) {
    const double weight = 1.0 / ms, weighted_size = size / ms;
    aa += weight * weight, ab += weight * weighted_size, bb += weighted_size * weighted_size;
    a += weight, b += weighted_size;
  }
  const double determinant = aa * bb - ab * ab;
  if (determinant <= 1e-12 * aa * bb) // all of one size
    return {0.0, b / bb};
  const StraightLine line{(a * bb - b * ab) / determinant, (aa * b - ab * a) / determinant};
  if (line.fixed_ms < 0.0)
    return {0.0, b / bb};
  if (line.slope_ms < 0.0)
    return {a / aa, 0.0};
  return line;
}

RandomCheck check_at_random(const Setup &setup, const Measurement &found, const std::string &device) {
  const auto &[scene, sensors, illuminators, others] = setup.start;
  const Sensor &sensor = sensors.front();
  const double each = static_cast<double>(diode_count(illuminators)) * sensor.samples * sensor.samples *
                      static_cast<double>(sensor.modulation_hz.size());
  const auto count =
      std::clamp(static_cast<std::size_t>(checked_interactions / each), fewest_checked, most_checked);
  const std::vector<std::uint32_t> pixels = random_pixels(sensor.pixel_count(), count);
  const reference::Frame truth = reference::simulate(scene, sensor, illuminators, setup.backscatter,
                                                     {.shadows = setup.shadows, .pixels = pixels},
                                                     [](double) { throw_if_interrupted(); });
  RandomCheck check{0.0, pixels.size()};
  for (std::size_t frequency = 0; frequency < sensor.modulation_hz.size(); ++frequency) {
    const double limit_m =
        largest_plausible_error_m(sensor.ambiguity_m(frequency), found.accuracy.claimed_m.value_or(0.0));
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double error_m =
          std::abs(std::remainder(static_cast<double>(found.returns[frequency].distance_m[pixels[i]]) -
                                      truth.returns[frequency].distance_m[i],
                                  sensor.ambiguity_m(frequency)));
      if (!(error_m <= limit_m))
        throw Error(ExitCode::internal,
                    fmt::format("{}: the distance of pixel {} differs from the reference by {:.6g} mm; "
                                "expected at most {:.6g} mm",
                                device, pixels[i], 1e3 * error_m, 1e3 * limit_m));
      check.error_m = std::max(check.error_m, error_m);
    }
  }
  return check;
}

std::vector<SweepRow> run_sweep(const std::vector<std::vector<SweepPoint>> &sweeps,
                                const BenchRequest &request) {
  double work_s = 0.0;
  for (const std::vector<SweepPoint> &points : sweeps)
    for (const SweepPoint &point : points)
      work_s += expected_s(point);
  ProgressBar bar(work_s);
  std::vector<SweepRow> rows;
  for (const std::vector<SweepPoint> &points : sweeps)
    for (SweepRow &row : PointsInTurn(points, request).measure(bar))
      rows.push_back(std::move(row));
  return rows;
}

std::vector<Growth> growths_of(const std::vector<SweepRow> &rows) {
  std::vector<Growth> growths;
  for (const SweepRow &row : rows) {
    if (growths.empty() || growths.back().quantity != row.point.quantity)
      growths.push_back({row.point.quantity, {}, {}, {}});
    growths.back().points.push_back({row.point.units(), timing_of(row.frames).frame_ms.median});
  }
  for (auto &[quantity, points, line, marginal_ms] : growths) {
    line = straight_line(points);
    marginal_ms = {std::numeric_limits<double>::quiet_NaN()};
    for (std::size_t i = 1; i < points.size(); ++i)
      marginal_ms.push_back((points[i].ms - points[i - 1].ms) / (points[i].size - points[i - 1].size));
  }
  return growths;
}

} // namespace pmdsim
