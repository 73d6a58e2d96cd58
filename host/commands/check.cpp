#include "engine/model/tap_sequence.h"
#include "engine/simulator.h"
#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/memory/byte_count.h"
#include "host/memory/machine_memory.h"
#include "host/output/files/manifest.h"
#include "host/report/findings.h"
#include "host/report/frame_findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <optional>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json sensor_json(const SensorFindings &findings) {
  const auto &[sensor, view, visible, shares_beyond, electrons] = findings;
  return {{"name", sensor.name},
          {"resolution", {sensor.resolution.x, sensor.resolution.y}},
          {"samples", sample_choice_json({sensor.samples, sensor.adaptive_samples})},
          {"image_distance_m", sensor.image_distance_m()},
          {"field_of_view_deg", {view.horizontal_deg, view.vertical_deg}},
          {"field_of_view_diagonal_deg", view.diagonal_deg},
          {"pixel_footprint_at_1m_m", {view.footprint_at_1m_m.x, view.footprint_at_1m_m.y}},
          {"vignetting_darkest_corner", view.darkest_corner},
          {"visible_range_m", {visible.min_m, visible.max_m}},
          {"modulation_hz", sensor.modulation_hz},
          {"ambiguity_m", ambiguities_m(sensor)},
          {"share_beyond_ambiguity", shares_beyond},
          {"common_ambiguity_m", or_null(common_ambiguity_m(sensor.modulation_hz))},
          {"waveform", waveform_json(sensor.waveform)},
          {"taps", sensor.taps},
          {"tap_interval_s", sensor.tap_interval_s},
          {"tap_sequence_s", tap_sequence_s(sensor)},
          {"electrons", electrons_json(electrons)}};
}

double end_s(const FrameTimes &frames) { return frames.time_s(frames.count - 1); }

ordered_json frames_json(const FrameTimes &frames) {
  return {{"start_s", frames.start_s},
          {"rate_hz", frames.count > 1 && frames.times_s.empty() ? ordered_json(frames.rate_hz) : nullptr},
          {"count", frames.count},
          {"span_s", end_s(frames) - frames.start_s}};
}

ordered_json light_json(const LightFindings &light) {
  return {{"diodes", light.diodes}, {"intensity_w_sr", light.intensity_w_sr}, {"power_w", light.power_w}};
}

ordered_json illuminators_json(const Findings &findings) {
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < findings.illuminators.size(); ++i) {
    const auto &[name, light] = findings.illuminators[i];
    const auto &[min_m, max_m, largest_lean_deg, turned_away] = findings.boards[i];
    ordered_json json{{"name", name}};
    json.update(light_json(light));
    json["places_m"] = {{min_m.x, max_m.x}, {min_m.y, max_m.y}, {min_m.z, max_m.z}};
    json["largest_lean_deg"] = largest_lean_deg;
    json["turned_away"] = turned_away;
    all.push_back(json);
  }
  return all;
}

// Of all sensors' first frames; nothing without bounces.
std::optional<BouncesForecast> forecast_of(const Setup &setup) {
  if (!setup.bounces.any())
    return std::nullopt;
  BouncesForecast all;
  for (const Sensor &sensor : setup.start.sensors) {
    const BouncesForecast of_sensor = forecast_bounces(setup.start.scene, sensor, setup.bounces);
    all.elements = std::max(all.elements, of_sensor.elements);
    all.frame_s += of_sensor.frame_s;
  }
  return all;
}

ordered_json bounces_json(const Setup &setup, const std::optional<BouncesForecast> &forecast) {
  ordered_json json{{"bounces", setup.as_used.at("bounces")}, {"bounce_error_m", setup.bounces.max_error_m}};
  if (forecast) {
    json["bounce_elements"] = forecast->elements;
    json["bounce_time_s"] = forecast->frame_s;
  }
  return json;
}

// Of a frame of each sensor as `render` measures it, with what the setup has taken.
struct MemoryFindings {
  std::uint64_t of_setup;
  MemoryForecast of_frame; // the largest
};

MemoryFindings memory_of(const Setup &setup) {
  MemoryFindings findings{taken_memory(), {}};
  for (const Sensor &sensor : setup.start.sensors) {
    MemoryForecast forecast = forecast_of(setup, sensor, {.taps = true}, MeasuredBy::device_in_host,
                                          bytes_of_largest_frame(setup, true));
    if (forecast.bytes() > findings.of_frame.bytes())
      findings.of_frame = std::move(forecast);
  }
  return findings;
}

ordered_json memory_json(const MemoryFindings &findings) {
  ordered_json parts = ordered_json::array();
  for (const MemoryPart &part : findings.of_frame.parts)
    parts.push_back({{"what", part.what}, {"bytes", part.bytes}});
  return {{"bytes", findings.of_setup + findings.of_frame.bytes()},
          {"setup_bytes", findings.of_setup},
          {"frame", parts}};
}

std::string memory_text(const MemoryFindings &findings) {
  return fmt::format("about {}: {} for the setup, {}",
                     byte_text(findings.of_setup + findings.of_frame.bytes()), byte_text(findings.of_setup),
                     memory_text(findings.of_frame));
}

// That nothing is seen comes first: all else is in vain then.
std::vector<Warning> all_warnings(const Setup &setup, const Findings &findings) {
  std::vector<Warning> warnings = setup.warnings;
  std::ranges::copy(warnings_of(setup, findings), std::back_inserter(warnings));
  std::ranges::stable_partition(warnings,
                                [](const Warning &warning) { return warning.code == "nothing-in-view"; });
  return warnings;
}

// The keys of the first sensor (and its first frequency) stand at the top too.
ordered_json report_json(const Setup &setup, const Findings &findings, const MemoryFindings &memory) {
  const ordered_json sensors = array_of(findings.sensors, sensor_json);
  ordered_json report{{"triangles", setup.start.scene.triangles.size()},
                      {"points", setup.start.scene.discs.size()},
                      {"objects", objects_json(setup.start.scene.objects)}};
  report.update(light_json(findings.light));
  report["shadows"] = setup.shadows == Shadows::automatic ? "auto" : "off";
  report["shadow_casters"] = findings.shadow_casters;
  report.update(bounces_json(setup, forecast_of(setup)));
  report["frames"] = frames_json(setup.frames);
  report["moves"] = setup.motion != nullptr;
  report["memory"] = memory_json(memory);
  report["ambiguity_m"] = sensors[0]["ambiguity_m"][0];
  for (const char *key :
       {"image_distance_m", "field_of_view_deg", "pixel_footprint_at_1m_m", "visible_range_m"})
    report[key] = sensors[0][key];
  report["illuminators"] = illuminators_json(findings);
  report["sensors"] = sensors;
  report["warnings"] = array_of(all_warnings(setup, findings), warning_json);
  return report;
}

std::string line(const std::string &name, const std::string &value) {
  return fmt::format("{:<24} {}\n", name, value);
}

std::string visible_text(const VisibleRange &range) {
  return range.is_empty() ? "nothing"
                          : fmt::format("{:.4g} m to {:.4g} m from the lens", range.min_m, range.max_m);
}

std::string waveform_text(const Waveform &waveform) {
  const ordered_json json = waveform_json(waveform);
  return json.is_string() ? json.get<std::string>()
                          : fmt::format("harmonics {}", fmt::join(waveform.harmonics, ", "));
}

std::string frequencies_text(const Sensor &sensor) {
  std::string text;
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    text += line("ambiguity range", fmt::format("{:.6g} m at {}", sensor.ambiguity_m(i),
                                                frequency_text(sensor.modulation_hz[i])));
  const std::optional<double> common_m = common_ambiguity_m(sensor.modulation_hz);
  if (sensor.modulation_hz.size() > 1 && common_m)
    text += line("", fmt::format("{:.6g} m of all frequencies together", *common_m));
  return text;
}

std::string field_of_view_text(const FieldOfView &view) {
  if (std::isnan(view.diagonal_deg))
    return "dark in the corners, as the distortion folds over before them";
  return fmt::format("{:.3f}° x {:.3f}°, {:.3f}° along the diagonal", view.horizontal_deg, view.vertical_deg,
                     view.diagonal_deg);
}

// The view of the scene's camera where it is another than the sensor's, as lenses come from the setup.
std::string scene_camera_text(const SceneCamera &camera, const SensorFindings &findings) {
  constexpr double least_difference_deg = 1.0;
  const glm::dvec2 view_deg = view_of_camera_deg(camera.view, findings.sensor);
  if (std::abs(view_deg.x - findings.view.horizontal_deg) <= least_difference_deg)
    return "";
  const auto focal_length_m = focal_length_like(camera.view, findings.sensor);
  return line("  of its camera node",
              fmt::format("{:.3f}° x {:.3f}° ({}){}", view_deg.x, view_deg.y, in_quotes(camera.node),
                          focal_length_m
                              ? fmt::format("; \"focal_length_m\": {:.4g} is as wide", *focal_length_m)
                              : ""));
}

std::string sensor_text(const SensorFindings &findings, const std::optional<SceneCamera> &camera) {
  const auto &[sensor, view, visible, shares_beyond, electrons] = findings;
  const glm::dvec2 footprint_mm = 1e3 * view.footprint_at_1m_m;
  std::string text =
      "\n" + line("sensor", sensor.name) + line("visible", visible_text(visible)) +
      line("resolution",
           fmt::format("{} x {}, {}{} x {} samples a pixel", sensor.resolution.x, sensor.resolution.y,
                       sensor.adaptive_samples ? "up to " : "", sensor.samples, sensor.samples)) +
      line("field of view", field_of_view_text(view)) + (camera ? scene_camera_text(*camera, findings) : "") +
      line("pixel footprint at 1 m", fmt::format("{:.4g} mm x {:.4g} mm", footprint_mm.x, footprint_mm.y)) +
      line("image distance", fmt::format("{:.6g} mm", 1e3 * sensor.image_distance_m()));
  if (sensor.vignetting == Vignetting::cos4)
    text += line("vignetting",
                 fmt::format("cos^4, {:.3g} of the light in the darkest corner", view.darkest_corner));
  text += line("waveform", fmt::format("{}, {} taps", waveform_text(sensor.waveform), sensor.taps));
  if (const double sequence_s = tap_sequence_s(sensor); sequence_s > 0.0)
    text += line("taps of a frame",
                 fmt::format("{} one after the other, {:.6g} s each, {:.6g} s in all",
                             sensor.taps * sensor.modulation_hz.size(), sensor.tap_interval_s, sequence_s));
  text += frequencies_text(sensor);
  return electrons ? text + line("electrons", electrons_text(*electrons)) : text;
}

std::string frames_text(const FrameTimes &frames) {
  if (frames.count == 1)
    return fmt::format("1, at {:.6g} s", frames.start_s);
  const std::string when =
      frames.times_s.empty() ? fmt::format("{:.6g} Hz", frames.rate_hz) : "the times of the poses";
  return fmt::format("{} at {}, from {:.6g} s to {:.6g} s", frames.count, when, frames.start_s,
                     end_s(frames));
}

std::string light_text(const LightFindings &light) {
  return fmt::format("{}, {:.6g} W/sr on their axes, {:.6g} W of modulated power", light.diodes,
                     light.intensity_w_sr, light.power_w);
}

std::string illuminators_text(const Findings &findings) {
  std::string text = line("diodes", light_text(findings.light));
  for (std::size_t i = 0; i < findings.illuminators.size(); ++i) {
    const auto &[name, light] = findings.illuminators[i];
    const std::string of_it =
        findings.illuminators.size() > 1 ? light_text(light) : fmt::format("{}", light.diodes);
    text += line("  of " + name, of_it + "; " + board_text(findings.boards[i]));
  }
  return text;
}

std::string shadows_text(Shadows shadows, std::size_t casters) {
  if (shadows == Shadows::off)
    return "off, light passes through everything";
  return casters == 0 ? "on, but there is nothing that could cast any"
                      : fmt::format("on, {} shapes that may cast them", casters);
}

std::string bounces_text(const Setup &setup) {
  if (!setup.bounces.any())
    return "0, light comes by one surface alone";
  const std::string count =
      setup.bounces.count == all_bounces ? "all" : fmt::format("{}", setup.bounces.count);
  const std::optional<BouncesForecast> forecast = forecast_of(setup);
  return fmt::format("{}, multipath within {:.6g} mm is asked for: {} elements at first, a frame in about "
                     "{:.1g} s if they suffice, else up to ten times that",
                     count, 1e3 * setup.bounces.max_error_m, forecast->elements, forecast->frame_s);
}

// The first few, by object_id; a name may hold anything, so it stands as JSON has it.
std::string objects_text(const std::vector<std::string> &objects) {
  constexpr std::size_t most = 8;
  std::string text = fmt::format("{}", objects.size());
  for (std::size_t id = 0; id < std::min(objects.size(), most); ++id)
    text +=
        fmt::format("{} {} {}", id == 0 ? ":" : ",", id,
                    ordered_json(objects[id]).dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  return text + (objects.size() > most ? ", ... (--json has all)" : "");
}

std::string report_text(const Setup &setup, const Findings &findings, const MemoryFindings &memory) {
  const Scene &scene = setup.start.scene;
  std::string text = fmt::format("{} is valid\n\n", setup.file.string()) +
                     line("triangles", fmt::format("{}", scene.triangles.size()));
  if (!scene.discs.empty())
    text += line("points", fmt::format("{}", scene.discs.size()));
  text += line("objects", objects_text(scene.objects));
  text += illuminators_text(findings) +
          line("shadows", shadows_text(setup.shadows, findings.shadow_casters)) +
          line("bounces", bounces_text(setup)) + line("frames", frames_text(setup.frames)) +
          line("motion", setup.motion ? "the scene moves; what is visible is told of the first frame"
                                      : "nothing moves") +
          line("memory", memory_text(memory));
  for (std::size_t i = 0; i < findings.sensors.size(); ++i)
    text += sensor_text(findings.sensors[i], setup.cameras.at(i));
  return text;
}

} // namespace

void run_check(const Options &options) {
  SetupLoader loader; // whose warnings are told in one list with those of the findings
  const Setup setup = loader.load(requested_document(options.capture, options.capture.setup));
  const MemoryFindings memory = memory_of(setup); // first, as findings take some, too
  const Findings findings = findings_of(setup);
  const std::vector<Warning> warnings = all_warnings(setup, findings);
  if (options.capture.accuracy.strict)
    refuse_warnings(warnings);
  for (const Warning &warning : warnings)
    warn(warning);
  print(options.json ? json_text(report_json(setup, findings, memory))
                     : report_text(setup, findings, memory));
}

} // namespace pmdsim
