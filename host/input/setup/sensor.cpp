#include "host/input/setup/sensor.h"

#include "host/input/schema/limits.h"
#include "host/input/setup/lens_check.h"
#include "host/input/setup/pose.h"
#include "host/input/setup/sample_choice.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

glm::dvec2 pair_of(const ordered_json &numbers) {
  const auto [x, y] = numbers.get<std::array<double, 2>>();
  return {x, y};
}

glm::dvec3 triple_of(const ordered_json &numbers) {
  const auto [x, y, z] = numbers.get<std::array<double, 3>>();
  return {x, y, z};
}

double focus_distance_m(const ordered_json &sensor, const Place &place) {
  const ordered_json &focus = sensor.at("focus_distance_m");
  if (focus.is_null())
    return std::numeric_limits<double>::infinity();
  const auto distance_m = focus.get<double>();
  if (distance_m <= sensor.at("focal_length_m").get<double>())
    throw input_error(place / "focus_distance_m", fmt::format("expected more than the focal length of {} m",
                                                              sensor.at("focal_length_m").dump()));
  return distance_m;
}

Distortion distortion_of(const ordered_json &distortion) {
  const auto number = [&](const char *key) { return distortion.at(key).get<double>(); };
  if (distortion.at("model") == "fisheye")
    return Fisheye{number("k1"), number("k2"), number("k3"), number("k4")};
  const BrownConrady brown{number("k1"), number("k2"), number("p1"), number("p2"), number("k3")};
  const bool bends =
      brown.k1 != 0.0 || brown.k2 != 0.0 || brown.p1 != 0.0 || brown.p2 != 0.0 || brown.k3 != 0.0;
  return bends ? Distortion(brown) : Distortion();
}

Waveform waveform_of(const ordered_json &waveform, const Place &place) {
  if (waveform == "sine")
    return {};
  if (waveform == "square")
    return {Waveform::Kind::square, {}};
  const auto harmonics = waveform.at("harmonics").get<std::vector<double>>();
  if (std::ranges::all_of(harmonics, [](double amplitude) { return amplitude == 0.0; }))
    throw input_error(place / "harmonics", "expected at least one amplitude other than 0");
  return {Waveform::Kind::harmonics, harmonics};
}

void check_highest_harmonic(const Sensor &sensor, const Place &place) {
  const std::size_t harmonics = sensor.waveform.harmonics.size();
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    if (sensor.modulation_hz[i] * static_cast<double>(harmonics) > max_modulation_hz)
      throw input_error(place / "modulation_hz" / i,
                        fmt::format("expected harmonic {} of the waveform within {} Hz, found {} Hz",
                                    harmonics, max_modulation_hz,
                                    sensor.modulation_hz[i] * static_cast<double>(harmonics)));
}

void check_lens(const Sensor &sensor, const Place &place) {
  if (const auto problem = lens_problem(sensor))
    throw input_error(place / problem->key, problem->expectation);
}

} // namespace

Sensor sensor_of(const ordered_json &sensor, const Place &place, const GltfScene &scene) {
  Sensor result;
  result.name = sensor.at("name");
  result.resolution = pair_of(sensor.at("resolution"));
  result.pixel_pitch_m = pair_of(sensor.at("pixel_pitch_m"));
  result.fill_factor = pair_of(sensor.at("fill_factor"));
  result.focal_length_m = sensor.at("focal_length_m");
  result.focus_distance_m = focus_distance_m(sensor, place);
  result.distortion = distortion_of(sensor.at("distortion"));
  result.chip.rotation_rad = glm::radians(triple_of(sensor.at("chip").at("rotation_deg")));
  result.chip.translation_m = triple_of(sensor.at("chip").at("translation_m"));
  result.vignetting = sensor.at("vignetting") == "cos4" ? Vignetting::cos4 : Vignetting::none;
  result.world_from_camera = world_from_frame(sensor.at("pose"), place / "pose", scene, {});
  result.modulation_hz = sensor.at("modulation_hz").get<std::vector<double>>();
  result.waveform = waveform_of(sensor.at("waveform"), place / "waveform");
  result.taps = sensor.at("taps");
  result.tap_interval_s = sensor.at("tap_interval_s");
  set_samples(result, sample_choice_of(sensor.at("samples")));
  check_highest_harmonic(result, place);
  check_lens(result, place);
  return result;
}

} // namespace pmdsim
