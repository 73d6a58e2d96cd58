#include "host/bench/native/kernel_work.h"

#include "engine/lens/lens.h"
#include "engine/model/error.h"
#include "host/report/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace pmdsim {
namespace {

// What float32 keeps of distances of some tens of metres.
constexpr double largest_error_m = 10e-6;
constexpr double largest_series_error_m = 1e-6; // beyond that of the moments
constexpr std::array<std::size_t, 4> series_powers{4, 6, 8, 12};

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

std::optional<double> settle_series(NativeKernel &kernel, double moments_error_m) {
  for (const std::size_t powers : series_powers) {
    kernel.set_series_powers(powers);
    kernel.run_s(NativeForm::series);
    if (const double error_m = kernel.error_max_m(); error_m <= moments_error_m + largest_series_error_m)
      return error_m;
  }
  return std::nullopt;
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

CheckedKernel checked_kernel(const ChosenWork &chosen, const NativeSums &sums, unsigned threads) {
  CheckedKernel checked{NativeKernel(chosen.work, sums, threads), chosen.points, 0.0, std::nullopt};
  checked.kernel.run_s(NativeForm::moments);
  checked.moments_error_m = checked.kernel.error_max_m();
  if (checked.moments_error_m <= largest_error_m) {
    checked.series_error_m = settle_series(checked.kernel, checked.moments_error_m);
    return checked;
  }
  const ChosenWork other = ring_and_wall_because("the setup takes more moments");
  if (chosen.points == other.points)
    throw Error(ExitCode::internal,
                fmt::format("the native kernel is off by {}; expected at most {}",
                            micrometres_text(checked.moments_error_m), micrometres_text(largest_error_m)));
  return checked_kernel(other, sums, threads);
}

} // namespace pmdsim
