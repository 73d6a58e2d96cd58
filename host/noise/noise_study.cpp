#include "host/noise/noise_study.h"

#include "engine/electronics/electrons.h"
#include "engine/electronics/photon_chain.h"
#include "engine/model/error.h"
#include "engine/reference/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::array reflectivities{0.1, 0.5, 0.9};
constexpr int distances = 21, levels = 24;
constexpr double nearest_m = 0.2, farthest_m = 100.0;
constexpr std::uint32_t dots = 4096; // pixels of a frame that a dot is found from

// Called now and then; may throw to stop.
using Between = std::function<void()>;

double of_range(double first, double last, int i, int count) {
  return first * std::pow(last / first, static_cast<double>(i) / (count - 1));
}

// A frame of `dots` pixels that see the same, counted.
Measurement counted(Sensor sensor, Measurement light, std::uint32_t number, const Between &between) {
  sensor.resolution = light.resolution = {dots, 1};
  light.number.frame = number;
  count_electrons(sensor, {.keep_taps = true, .between = between}, light);
  return light;
}

Measurement even_light(double radiance) {
  Measurement light;
  light.mean_radiance.assign(dots, static_cast<float>(radiance));
  Return &of = light.returns.emplace_back();
  of.amplitude.assign(dots, 0.0f);
  of.phase_rad.assign(dots, 0.0f);
  of.distance_m.assign(dots, 0.0f);
  return light;
}

// The figures of one frequency's electronics alone, without what is not temporal noise of the own light.
Sensor of_frequency(Sensor sensor, std::size_t frequency) {
  Electronics &electronics = *sensor.electronics;
  electronics.demodulation_contrast = {electronics.contrast(frequency)};
  sensor.modulation_hz = {sensor.modulation_hz[frequency]};
  electronics.dsnu_e = electronics.prnu = 0.0;
  electronics.noiseless_channels = false;
  if (const std::vector<float> &picture = electronics.background_image; !picture.empty())
    electronics.background_radiance_w_m2_sr *=
        std::accumulate(picture.begin(), picture.end(), 0.0) / static_cast<double>(picture.size());
  electronics.background_image.clear();
  return sensor;
}

TransferPoint transfer_point(const Sensor &of, double signal_e, std::uint32_t number,
                             const Between &between) {
  Sensor sensor = of;
  Electronics &electronics = *sensor.electronics;
  electronics.background_radiance_w_m2_sr = electronics.sbi_e = 0.0; // no light but the level's
  electronics.frames_averaged = electronics.parts_averaged = 1;      // of one reading
  sensor.waveform = {};
  const double dark_e = 0.5 * electronics.dark_current_e_per_s * electronics.integration_time_s;
  const double mean_e = signal_e + dark_e, gain = electronics.gain_dn_per_e;
  TransferPoint point{.signal_e = signal_e,
                      .mean_dn = gain * mean_e + electronics.offset_dn,
                      .variance_dn2 = gain * gain * (mean_e + reading_variance_e2(electronics))};
  point.is_full = mean_e > electronics.full_well_e || point.mean_dn > electronics.largest_dn();
  if (point.is_full) {
    point.mean_dn =
        std::min(gain * electronics.full_well_e + electronics.offset_dn, electronics.largest_dn());
    point.variance_dn2 = 0.0;
  }
  const Measurement light = even_light(2.0 * signal_e / electrons_of(1.0, sensor));
  const std::vector<float> first = counted(sensor, light, 2 * number, between).returns[0].tap_a_dn[0],
                           second = counted(sensor, light, 2 * number + 1, between).returns[0].tap_a_dn[0];
  for (std::size_t i = 0; i < dots; ++i) {
    const auto a = static_cast<double>(first[i]), b = static_cast<double>(second[i]);
    point.found_mean_dn += 0.5 * (a + b) / dots;
    point.found_variance_dn2 += 0.5 * (a - b) * (a - b) / dots;
  }
  return point;
}

// Dark, and from far below the read noise to beyond the full well.
std::vector<TransferPoint> photon_transfer(const Sensor &sensor, const Between &between) {
  const double full_e = sensor.electronics->full_well_e;
  std::vector<TransferPoint> points{transfer_point(sensor, 0.0, 0, between)};
  for (int i = 0; i < levels; ++i)
    points.push_back(transfer_point(sensor, of_range(1e-4 * full_e, 1.6 * full_e, i, levels),
                                    static_cast<std::uint32_t>(i + 1), between));
  return points;
}

// A white wall across the optical axis that fills whatever the pixel sees.
Scene wall_before(const Sensor &sensor, double distance_m) {
  const double half_m = 10.0 * distance_m;
  Scene scene;
  for (const glm::dvec2 corner : {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)})
    scene.positions_m.push_back(sensor.world_from_camera.point({half_m * corner, distance_m}));
  scene.surfaces.push_back({.reflectivity = 1.0, .double_sided = true});
  scene.objects.emplace_back("wall");
  scene.triangles = {{{0, 2, 1}, 0, 0}, {{0, 3, 2}, 0, 0}};
  return scene;
}

// The light that the pixel in the image's centre gets from a white wall.
reference::Frame white_light(const Setup &setup, const Sensor &of, double distance_m) {
  Sensor sensor = of;
  sensor.resolution = {1, 1};
  sensor.chip = {};
  sensor.distortion = {};
  return reference::simulate(wall_before(sensor, distance_m), sensor, setup.start.illuminators,
                             setup.backscatter);
}

NoiseShares shares_of(const Sensor &sensor, double signal_e) {
  const Electronics &electronics = *sensor.electronics;
  const double readings = electronics.two_tap ? 2.0 : 1.0, part = 0.5 * readings;
  const double background_e = electrons_of(electronics.background_radiance_w_m2_sr, sensor);
  const double dark_e = electronics.dark_current_e_per_s * electronics.integration_time_s;
  const double read_e2 = readings * electronics.read_noise_e * electronics.read_noise_e;
  const double adc_e2 = readings * step_variance_e2(electronics);
  const double all = part * (signal_e + background_e + dark_e) + read_e2 + adc_e2;
  return {part * signal_e / all, part * background_e / all, part * dark_e / all, read_e2 / all, adc_e2 / all};
}

// The root of the mean square of what the distances that are known are off the true one by; nothing where
// most are not.
std::optional<double> found_noise_m(const std::vector<float> &distances_m, double true_m,
                                    double ambiguity_m) {
  double sum = 0.0, known = 0.0;
  for (const float distance_m : distances_m) {
    if (std::isnan(distance_m))
      continue;
    const double off_m = std::remainder(static_cast<double>(distance_m) - true_m, ambiguity_m);
    sum += off_m * off_m;
    known += 1.0;
  }
  const bool are_most = known > 0.5 * static_cast<double>(distances_m.size());
  return are_most ? std::optional(std::sqrt(sum / known)) : std::nullopt;
}

PrecisionPoint precision_point(const Sensor &sensor, const reference::Frame &white, double reflectivity,
                               double distance_m, std::uint32_t number, const Between &between) {
  const reference::FrameReturn &of_white = white.returns[0];
  const auto scaled = [&](double value) { return static_cast<float>(reflectivity * value); };
  Measurement light = even_light(reflectivity * white.mean_radiance[0]);
  Return &of = light.returns[0];
  of.amplitude.assign(dots, scaled(of_white.amplitude[0]));
  of.phase_rad.assign(dots, static_cast<float>(of_white.phase_rad[0]));
  for (const std::vector<double> &tap : of_white.taps)
    of.taps.emplace_back(dots, scaled(tap[0]));
  const Return frame = counted(sensor, std::move(light), number, between).returns[0];
  PrecisionPoint point{.reflectivity = reflectivity, .distance_m = distance_m};
  point.signal_e = electrons_of(reflectivity * white.mean_radiance[0], sensor);
  point.shares = shares_of(sensor, point.signal_e);
  const bool is_lit = of_white.amplitude[0] > 0.0;
  point.is_full = is_lit && std::isnan(frame.distance_noise_m[0]);
  if (!is_lit || point.is_full)
    return point;
  point.predicted_m = static_cast<double>(frame.distance_noise_m[0]);
  point.found_m = found_noise_m(frame.distance_m, of_white.distance_m[0], sensor.ambiguity_m());
  return point;
}

std::vector<PrecisionPoint> precision(const Setup &setup, const Sensor &sensor, const Between &between) {
  const double of_sensor_m = std::max(sensor.ambiguity_m(), sensor.unwrap_range_m);
  const double last_m = std::clamp(of_sensor_m, 2.0 * nearest_m, farthest_m);
  std::vector<std::pair<double, reference::Frame>> walls;
  for (int i = 0; i < distances; ++i) {
    const double distance_m = of_range(nearest_m, last_m, i, distances);
    walls.emplace_back(distance_m, white_light(setup, sensor, distance_m));
  }
  std::vector<PrecisionPoint> points;
  for (const double reflectivity : reflectivities)
    for (const auto &[distance_m, white] : walls)
      points.push_back(precision_point(sensor, white, reflectivity, distance_m,
                                       static_cast<std::uint32_t>(points.size()), between));
  return points;
}

} // namespace

std::vector<NoiseStudy> study_noise(const Setup &setup, const std::function<void(double)> &progress) {
  std::vector<NoiseStudy> studies;
  std::size_t all = 0;
  for (const Sensor &sensor : setup.start.sensors)
    all += sensor.electronics ? sensor.modulation_hz.size() : 0;
  if (all == 0)
    throw Error(ExitCode::input,
                fmt::format("{}: /sensors: expected at least one with \"electronics\"", setup.file.string()));
  const Between between = [&] { progress(static_cast<double>(studies.size()) / static_cast<double>(all)); };
  for (const Sensor &sensor : setup.start.sensors)
    for (std::size_t i = 0; sensor.electronics && i < sensor.modulation_hz.size(); ++i) {
      const Sensor single = of_frequency(sensor, i);
      NoiseStudy study{.sensor = sensor.name,
                       .modulation_hz = sensor.modulation_hz[i],
                       .ambiguity_m = sensor.ambiguity_m(i)};
      if (sensor.modulation_hz.size() > 1)
        study.frequency = i;
      if (i == 0)
        study.transfer = photon_transfer(single, between);
      study.precision = precision(setup, single, between);
      studies.push_back(std::move(study));
      between();
    }
  return studies;
}

} // namespace pmdsim
