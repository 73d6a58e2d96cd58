#include "host/bench/native/native_bench.h"

#include "engine/lens/lens.h"
#include "engine/model/error.h"
#include "host/capture/camera.h"
#include "host/input/setup/setup.h"
#include "host/report/findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

// The error of float32 at distances of some tens of metres.
constexpr double largest_error_m = 10e-6;
constexpr double largest_series_error_m = 1e-6; // beyond that of the moments
// Enough for every thread, and little enough to be run in every round.
constexpr double most_interactions = 2e8;

// Why the kernel does not model the setup; empty where it does.
std::string not_modelled(const Setup &setup, const Sensor &sensor, const Measurement &measurement) {
  const std::vector<Illuminator> &illuminators = setup.start.illuminators;
  if (setup.backscatter != Backscatter::constant)
    return "the backscatter is not constant";
  if (sensor.waveform.kind != Waveform::Kind::sine)
    return "the waveform is no sine";
  for (const Illuminator &illuminator : illuminators) {
    if (illuminator.modulation_phase_rad != illuminators.front().modulation_phase_rad)
      return "the illuminators are not in phase";
    if (std::ranges::any_of(illuminator.diodes, [](const Diode &diode) {
          return diode.pattern.kind != Pattern::Kind::isotropic;
        }))
      return "the diodes are not isotropic";
  }
  for (std::size_t i = 0; i < measurement.lit.size(); ++i)
    if (measurement.coverage[i] > 0.0f && measurement.lit[i] < 1.0f)
      return "some diodes do not reach some points";
  return "";
}

std::vector<glm::dvec3> points_seen_m(const Sensor &sensor, const Measurement &measurement) {
  const Lens lens(sensor);
  std::vector<glm::dvec3> points_m;
  for (std::uint64_t i = 0; i < sensor.pixel_count(); ++i) {
    const glm::dvec2 centre(glm::dvec2(i % sensor.resolution.x, i / sensor.resolution.x) + 0.5);
    const auto ray = lens.ray(lens.on_chip_m(centre));
    const auto range_m = static_cast<double>(measurement.range_m[i]);
    if (ray && range_m > 0.0) // NaN where nothing is seen
      points_m.push_back(range_m * *ray);
  }
  return points_m;
}

// Camera frame.
std::vector<NativeWork::Source> sources_of(const std::vector<Illuminator> &illuminators,
                                           const Sensor &sensor) {
  std::vector<NativeWork::Source> sources;
  const Pose camera_from_world = inverse(sensor.world_from_camera);
  for (const Illuminator &illuminator : illuminators) {
    const Pose camera_from_illuminator = compose(camera_from_world, illuminator.world_from_illuminator);
    for (const Diode &diode : illuminator.diodes)
      sources.push_back({camera_from_illuminator.point(diode.position_m), diode.intensity_w_sr});
  }
  return sources;
}

ChosenWork ring_and_wall_because(const std::string &reason) {
  return {ring_and_wall(), "a ring's diodes and a wall's points, as " + reason};
}

ChosenWork work_of(const Setup &setup, const std::string &device) {
  Sensor sensor = setup.start.sensors.front();
  set_samples(sensor, {.samples = 1});
  const double interactions =
      static_cast<double>(sensor.pixel_count()) * static_cast<double>(diode_count(setup.start.illuminators));
  sensor = coarser(sensor, std::sqrt(interactions / most_interactions));
  Camera camera(device);
  camera.prepare(setup, sensor);
  return native_work(setup, sensor, camera.measure_light());
}

void find_series(NativeBench &bench, const NativeSums &sums) {
  for (const NativeSeries &series : sums.by_series) {
    bench.kernel.run_s(series.sum);
    bench.series_error_m = bench.kernel.error_max_m();
    if (bench.series_error_m <= bench.moments_error_m + largest_series_error_m) {
      bench.series = &series;
      return;
    }
  }
}

double rate(NativeKernel &kernel, NativeSum sum) {
  kernel.run_s(sum);
  return kernel.interactions() / kernel.run_s(sum);
}

} // namespace

NativeWork ring_and_wall() {
  constexpr std::size_t columns = 640, diodes = 240, rings = 5;
  NativeWork work;
  for (std::size_t i = 0; i < columns * columns; ++i) {
    const glm::dvec2 place = (glm::dvec2(i % columns, i / columns) + 0.5) / double{columns} - 0.5;
    work.points_m.emplace_back(0.4 * place, 2.0);
  }
  for (std::size_t i = 0; i < diodes; ++i) {
    const std::size_t k = i / rings;
    const double angle = 2.0 * std::numbers::pi * (static_cast<double>(k) + 0.5) * rings / diodes;
    const double radius_m = 0.126 + 0.010 * static_cast<double>(i % rings);
    work.diodes.push_back({{radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0}, 1.0});
  }
  return work;
}

ChosenWork native_work(const Setup &setup, const Sensor &sensor, const Measurement &measurement) {
  if (const std::string reason = not_modelled(setup, sensor, measurement); !reason.empty())
    return ring_and_wall_because(reason);
  NativeWork work{points_seen_m(sensor, measurement), sources_of(setup.start.illuminators, sensor),
                  sensor.modulation_hz.front()};
  if (work.points_m.empty())
    return ring_and_wall_because("nothing is seen");
  if (std::ranges::none_of(work.diodes, [](const auto &diode) { return diode.intensity_w_sr > 0.0; }))
    return ring_and_wall_because("the diodes are dark");
  return {work, "the setup's diodes and points"};
}

NativeBench checked_bench(const ChosenWork &chosen, const NativeSums &sums, unsigned threads) {
  NativeBench bench{NativeKernel(chosen.work, sums, threads), chosen.points};
  bench.kernel.run_s(sums.by_moments);
  bench.moments_error_m = bench.kernel.error_max_m();
  if (bench.moments_error_m <= largest_error_m) {
    find_series(bench, sums);
    return bench;
  }
  const ChosenWork other = ring_and_wall_because("the setup takes more moments");
  if (chosen.points == other.points)
    throw Error(ExitCode::internal,
                fmt::format("the native kernel is off by {}; expected at most {}",
                            micrometres_text(bench.moments_error_m), micrometres_text(largest_error_m)));
  return checked_bench(other, sums, threads);
}

NativeBench native_bench(const Setup &setup, const std::string &device) {
  return checked_bench(work_of(setup, device), *available_native_sums().front(), native_threads());
}

void NativeBench::run() {
  moments_per_s.push_back(rate(kernel, kernel.sums().by_moments));
  if (series)
    series_per_s.push_back(rate(kernel, series->sum));
}

} // namespace pmdsim
