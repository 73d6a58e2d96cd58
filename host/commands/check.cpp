#include "host/capture/capture.h"
#include "host/commands/commands.h"
#include "host/output/files/manifest.h"
#include "host/report/findings.h"
#include "host/report/report.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

ordered_json sensor_json(const SensorFindings &findings) {
  const auto &[sensor, view, visible, frequencies, common_ambiguity_m, sequence_s] = findings;
  ordered_json shares_beyond = ordered_json::array();
  for (const AmbiguityFinding &frequency : frequencies)
    shares_beyond.push_back(frequency.share_beyond);
  return {
      {"name", sensor.name},
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
      {"common_ambiguity_m", common_ambiguity_m ? ordered_json(*common_ambiguity_m) : ordered_json(nullptr)},
      {"waveform", waveform_json(sensor.waveform)},
      {"taps", sensor.taps},
      {"tap_interval_s", sensor.tap_interval_s},
      {"tap_sequence_s", sequence_s}};
}

// From the first frame's time to the last one's.
double span_s(const FrameTimes &frames) { return frames.time_s(frames.count - 1) - frames.start_s; }

ordered_json frames_json(const FrameTimes &frames) {
  return {{"start_s", frames.start_s},
          {"rate_hz", frames.count > 1 ? ordered_json(frames.rate_hz) : ordered_json(nullptr)},
          {"count", frames.count},
          {"span_s", span_s(frames)}};
}

ordered_json light_json(const LightFindings &light) {
  return {{"diodes", light.diodes}, {"intensity_w_sr", light.intensity_w_sr}, {"power_w", light.power_w}};
}

ordered_json illuminators_json(const Findings &findings) {
  ordered_json illuminators = ordered_json::array();
  for (const auto &[name, light] : findings.illuminators) {
    illuminators.push_back({{"name", name}});
    illuminators.back().update(light_json(light));
  }
  return illuminators;
}

// The keys of the first sensor (and its first frequency) stand at the top too.
ordered_json report_json(const Setup &setup, const Findings &findings) {
  std::vector<std::string> warnings = setup.warnings;
  std::ranges::copy(warnings_of(findings), std::back_inserter(warnings));
  ordered_json sensors = ordered_json::array();
  for (const SensorFindings &sensor : findings.sensors)
    sensors.push_back(sensor_json(sensor));
  ordered_json report{{"triangles", findings.triangles}, {"points", findings.points}};
  report.update(light_json(findings.light));
  report["shadows"] = findings.shadows == Shadows::automatic ? "auto" : "off";
  report["shadow_casters"] = findings.shadow_casters;
  report["frames"] = frames_json(findings.frames);
  report["moves"] = findings.moves;
  report["ambiguity_m"] = findings.sensors.front().frequencies.front().ambiguity_m;
  for (const char *key :
       {"image_distance_m", "field_of_view_deg", "pixel_footprint_at_1m_m", "visible_range_m"})
    report[key] = sensors.front()[key];
  report["illuminators"] = illuminators_json(findings);
  report["sensors"] = sensors;
  report["warnings"] = warnings;
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

std::string frequencies_text(const SensorFindings &findings) {
  std::string text;
  for (const AmbiguityFinding &frequency : findings.frequencies)
    text += line("ambiguity range", fmt::format("{:.6g} m at {}", frequency.ambiguity_m,
                                                frequency_text(frequency.modulation_hz)));
  if (findings.frequencies.size() > 1 && findings.common_ambiguity_m)
    text += line("", fmt::format("{:.6g} m of all frequencies together", *findings.common_ambiguity_m));
  return text;
}

std::string sensor_text(const SensorFindings &findings) {
  const auto &[sensor, view, visible, frequencies, common_ambiguity_m, sequence_s] = findings;
  const glm::dvec2 footprint_mm = 1e3 * view.footprint_at_1m_m;
  std::string text =
      "\n" + line("sensor", sensor.name) + line("visible", visible_text(visible)) +
      line("resolution",
           fmt::format("{} x {}, {}{} x {} samples a pixel", sensor.resolution.x, sensor.resolution.y,
                       sensor.adaptive_samples ? "up to " : "", sensor.samples, sensor.samples)) +
      line("field of view", fmt::format("{:.3f}° x {:.3f}°, {:.3f}° along the diagonal", view.horizontal_deg,
                                        view.vertical_deg, view.diagonal_deg)) +
      line("pixel footprint at 1 m", fmt::format("{:.4g} mm x {:.4g} mm", footprint_mm.x, footprint_mm.y)) +
      line("image distance", fmt::format("{:.6g} mm", 1e3 * sensor.image_distance_m()));
  if (sensor.vignetting == Vignetting::cos4)
    text += line("vignetting",
                 fmt::format("cos^4, {:.3g} of the light in the darkest corner", view.darkest_corner));
  text += line("waveform", fmt::format("{}, {} taps", waveform_text(sensor.waveform), sensor.taps));
  if (sequence_s > 0.0)
    text += line("taps of a frame",
                 fmt::format("{} one after the other, {:.6g} s each, {:.6g} s in all",
                             sensor.taps * sensor.modulation_hz.size(), sensor.tap_interval_s, sequence_s));
  return text + frequencies_text(findings);
}

std::string frames_text(const FrameTimes &frames) {
  if (frames.count == 1)
    return fmt::format("1, at {:.6g} s", frames.start_s);
  return fmt::format("{} at {:.6g} Hz, from {:.6g} s to {:.6g} s", frames.count, frames.rate_hz,
                     frames.start_s, frames.time_s(frames.count - 1));
}

std::string light_text(const LightFindings &light) {
  return fmt::format("{}, {:.6g} W/sr on their axes, {:.6g} W of modulated power", light.diodes,
                     light.intensity_w_sr, light.power_w);
}

std::string illuminators_text(const Findings &findings) {
  std::string text = line("diodes", light_text(findings.light));
  if (findings.illuminators.size() > 1)
    for (const auto &[name, light] : findings.illuminators)
      text += line("  of " + name, light_text(light));
  return text;
}

std::string points_text(std::size_t points) {
  return points == 0 ? std::string() : line("points", fmt::format("{}", points));
}

std::string shadows_text(const Findings &findings) {
  if (findings.shadows == Shadows::off)
    return "off, light passes through everything";
  return findings.shadow_casters == 0
             ? "on, but there is nothing that could cast any"
             : fmt::format("on, {} shapes that may cast them", findings.shadow_casters);
}

std::string report_text(const Setup &setup, const Findings &findings) {
  std::string text =
      fmt::format("{} is valid\n\n", setup.file.string()) +
      line("triangles", fmt::format("{}", findings.triangles)) + points_text(findings.points) +
      illuminators_text(findings) + line("shadows", shadows_text(findings)) +
      line("frames", frames_text(findings.frames)) +
      line("motion",
           findings.moves ? "the scene moves; what is visible is told of the first frame" : "nothing moves");
  for (const SensorFindings &sensor : findings.sensors)
    text += sensor_text(sensor);
  return text;
}

} // namespace

void run_check(const Options &options) {
  const Setup setup = requested_setup(options.capture);
  const Findings findings = findings_of(setup);
  for (const std::string &warning : warnings_of(findings))
    fmt::print(stderr, "pmdsim: warning: {}\n", warning);
  if (options.json)
    print(report_json(setup, findings));
  else
    print(report_text(setup, findings));
}

} // namespace pmdsim
