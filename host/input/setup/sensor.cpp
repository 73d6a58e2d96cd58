#include "engine/lens/lens.h"
#include "host/input/file/json_file.h"
#include "host/input/schema/limits.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

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

std::vector<ScatterLobe> scatter_of(const ordered_json &lobes, const Place &place) {
  std::vector<ScatterLobe> scatter;
  double shares = 0.0;
  for (const ordered_json &lobe : lobes) {
    scatter.push_back({lobe.at("share").get<double>(), lobe.at("sigma_m").get<double>()});
    shares += scatter.back().share;
  }
  if (shares > 1.0)
    throw input_error(place, fmt::format("expected shares that come to at most 1, found {}", shares));
  return scatter;
}

// Every ambiguity range of the highest frequency is tried.
double unwrap_range_m(double range_m, const Place &place, const Sensor &sensor) {
  constexpr double most_tries = 10'000.0;
  if (sensor.modulation_hz.size() < 2)
    throw input_error(place, "expected two frequencies or more beside it");
  const double highest_hz = std::ranges::max(sensor.modulation_hz);
  const double most_m = most_tries * speed_of_light_m_s / (2.0 * highest_hz);
  if (range_m > most_m)
    throw input_error(place,
                      fmt::format("expected at most {:.6g} m, {} ambiguity ranges of the highest frequency, "
                                  "found {}",
                                  most_m, most_tries, range_m));
  return range_m;
}

// The image's corners and, between them, the middles of its sides.
std::vector<glm::dvec2> rim(const Sensor &sensor) {
  std::vector<glm::dvec2> places;
  const glm::dvec2 end(sensor.resolution);
  for (const double row : {0.0, 0.5, 1.0})
    for (const double column : {0.0, 0.5, 1.0})
      if (row != 0.5 || column != 0.5)
        places.push_back(glm::dvec2(column, row) * end);
  return places;
}

// How far one gets from the optical axis towards a place without a ray, pixels.
double pixels_to_fold(const Lens &lens, const glm::dvec2 &axis_pixel, const glm::dvec2 &pixel) {
  constexpr int halvings = 50;
  double reached = 0.0, missed = 1.0; // of the way
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (reached + missed);
    (lens.ray(lens.on_chip_m(glm::mix(axis_pixel, pixel, middle))) ? reached : missed) = middle;
  }
  return reached * glm::length(pixel - axis_pixel);
}

std::string fold_expectation(const Sensor &sensor, const Lens &lens) {
  std::string text =
      "expected a distortion that does not fold over inside the image, or \"beyond\": \"dark\"";
  const std::optional<glm::dvec2> axis_m = lens.chip_m({0.0, 0.0, 1.0});
  const std::vector<glm::dvec2> places = rim(sensor);
  const auto place =
      std::ranges::find_if(places, [&](const glm::dvec2 &pixel) { return !lens.ray(lens.on_chip_m(pixel)); });
  if (!axis_m || place == places.end())
    return text;
  return fmt::format("{}; it does {:.4g} pixels from the optical axis towards column {}, row {}", text,
                     pixels_to_fold(lens, lens.pixel(*axis_m), *place), place->x, place->y);
}

LensProblem problem_of(LensFault fault, const Sensor &sensor, const Lens &lens) {
  switch (fault) {
  case LensFault::chip_behind_lens:
    return {"chip", "expected the whole chip in front of the lens"};
  case LensFault::distortion_folds:
    return {"distortion", fold_expectation(sensor, lens)};
  case LensFault::beyond_model:
    return {"distortion", std::holds_alternative<Fisheye>(sensor.distortion)
                              ? "expected an image within 179 degrees of the optical axis (fisheye)"
                              : "expected an image within 89 degrees of the optical axis (brown)"};
  case LensFault::pixel_too_wide:
    break;
  }
  return {"resolution", "expected pixels that see less than 120 degrees each"};
}

} // namespace

Sensor sensor_of(const ordered_json &sensor, const Place &place, const Surroundings &at) {
  Sensor result;
  sensor.at("name").get_to(result.name);
  sensor.at("resolution").get_to(result.resolution);
  sensor.at("pixel_pitch_m").get_to(result.pixel_pitch_m);
  sensor.at("fill_factor").get_to(result.fill_factor);
  sensor.at("focal_length_m").get_to(result.focal_length_m);
  result.focus_distance_m = focus_distance_m(sensor, place);
  result.distortion = distortion_of(sensor.at("distortion"));
  result.dark_beyond_fold = sensor.at("distortion").value("beyond", "refuse") == "dark";
  result.chip.rotation_rad = glm::radians(sensor.at("chip").at("rotation_deg").get<glm::dvec3>());
  sensor.at("chip").at("translation_m").get_to(result.chip.translation_m);
  result.vignetting = sensor.at("vignetting") == "cos4" ? Vignetting::cos4 : Vignetting::none;
  result.world_from_camera = world_from_frame(sensor.at("pose"), place / "pose", at, {});
  sensor.at("modulation_hz").get_to(result.modulation_hz);
  result.waveform = waveform_of(sensor.at("waveform"), place / "waveform");
  sensor.at("taps").get_to(result.taps);
  sensor.at("tap_interval_s").get_to(result.tap_interval_s);
  set_samples(result, sample_choice_of(sensor.at("samples")));
  result.scatter = scatter_of(sensor.at("scatter"), place / "scatter");
  if (sensor.contains("unwrap_range_m"))
    result.unwrap_range_m = unwrap_range_m(sensor.at("unwrap_range_m"), place / "unwrap_range_m", result);
  if (sensor.contains("electronics"))
    result.electronics = electronics_of(sensor.at("electronics"), place / "electronics", result);
  check_highest_harmonic(result, place);
  if (const auto problem = lens_problem(result))
    throw input_error(place / problem->key, problem->expectation);
  return result;
}

std::optional<LensProblem> lens_problem(const Sensor &sensor) {
  const Lens lens(sensor);
  const std::optional<LensFault> fault = lens_fault(sensor);
  if (fault != LensFault::chip_behind_lens && !(glm::determinant(lens.lens_from_chip()) > 0.0))
    return LensProblem{"chip", "expected the front of the chip towards the lens"};
  return fault ? std::optional(problem_of(*fault, sensor, lens)) : std::nullopt;
}

} // namespace pmdsim
