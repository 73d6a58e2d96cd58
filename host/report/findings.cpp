#include "host/report/findings.h"

#include "engine/model/tap_sequence.h"
#include "engine/reference/reference.h"
#include "host/report/field_of_view.h"
#include "host/report/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>

namespace pmdsim {
namespace {

constexpr double view_columns = 64.0; // rays that look for what is visible, along the frame's longer side

// Of what the rays of a coarse frame of the reference see, which needs no device.
std::vector<double> visible_ranges_m(const Setup &setup, const Sensor &fine) {
  Sensor sensor = coarser(fine, std::max(fine.resolution.x, fine.resolution.y) / view_columns);
  sensor.samples = 1;
  sensor.modulation_hz.resize(1); // geometry is all that is asked for
  sensor.waveform = {};
  std::vector<double> ranges_m =
      reference::simulate(setup.start.scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                          setup.backscatter)
          .range_m;
  std::erase_if(ranges_m, [](double range_m) { return std::isnan(range_m); });
  return ranges_m;
}

// 0 where nothing is visible.
double share_beyond(const std::vector<double> &ranges_m, double ambiguity_m) {
  const auto beyond = std::ranges::count_if(ranges_m, [&](double range_m) { return range_m >= ambiguity_m; });
  return ranges_m.empty() ? 0.0 : static_cast<double>(beyond) / static_cast<double>(ranges_m.size());
}

SensorFindings findings_of_sensor(const Setup &setup, const Sensor &sensor) {
  const std::vector<double> ranges_m = visible_ranges_m(setup, sensor);
  SensorFindings findings{sensor,
                          field_of_view(sensor),
                          {},
                          {},
                          common_ambiguity_m(sensor.modulation_hz),
                          tap_sequence_s(sensor)};
  if (!ranges_m.empty())
    findings.visible = {std::ranges::min(ranges_m), std::ranges::max(ranges_m)};
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i) {
    const double ambiguity_m = sensor.ambiguity_m(i);
    findings.frequencies.push_back(
        {sensor.modulation_hz[i], ambiguity_m, share_beyond(ranges_m, ambiguity_m)});
  }
  return findings;
}

// Many diodes share a diagram.
using DiagramAngles = std::map<const Diagram *, double>;

double known_or_new_sr(const Pattern &pattern, DiagramAngles &known_sr) {
  if (!pattern.diagram)
    return reference::solid_angle_sr(pattern);
  const auto [known, is_new] = known_sr.try_emplace(pattern.diagram.get(), 0.0);
  if (is_new)
    known->second = reference::solid_angle_sr(pattern);
  return known->second;
}

LightFindings findings_of_light(const Illuminator &illuminator, DiagramAngles &known_sr) {
  LightFindings light{illuminator.diodes.size()};
  for (const Diode &diode : illuminator.diodes) {
    light.intensity_w_sr += diode.intensity_w_sr;
    light.power_w += diode.intensity_w_sr * known_or_new_sr(diode.pattern, known_sr);
  }
  return light;
}

void add_warnings(std::vector<std::string> &warnings, const SensorFindings &findings) {
  const auto &[sensor, view, visible, frequencies, common, sequence_s] = findings;
  if (visible.is_empty())
    warnings.push_back(fmt::format("sensor {}: no ray of a coarse frame hits the scene; is the camera turned "
                                   "away, or are the scene's back faces culled?",
                                   sensor.name));
  for (const auto &[modulation_hz, ambiguity_m, share] : frequencies)
    if (share > 0.0)
      warnings.push_back(
          fmt::format("sensor {} at {}: what is visible lies {:.6g} m to {:.6g} m away, {:.3g} % "
                      "of it beyond the ambiguity range of {:.6g} m: distances wrap",
                      sensor.name, frequency_text(modulation_hz), visible.min_m, visible.max_m, 100.0 * share,
                      ambiguity_m));
}

void add_tap_warning(std::vector<std::string> &warnings, const SensorFindings &findings,
                     const FrameTimes &frames) {
  constexpr double rounding = 1e-9;
  const double frame_s = 1.0 / frames.rate_hz;
  if (frames.count > 1 && findings.tap_sequence_s > frame_s * (1.0 + rounding))
    warnings.push_back(
        fmt::format("sensor {}: its taps take {:.6g} s, longer than the {:.6g} s from one frame "
                    "to the next: frames overlap",
                    findings.sensor.name, findings.tap_sequence_s, frame_s));
}

// No shape stands in its own light.
std::size_t shadow_casters(const Setup &setup) {
  const std::size_t shapes = setup.start.scene.shape_count();
  return setup.shadows == Shadows::automatic && shapes > 1 ? shapes : 0;
}

} // namespace

Findings findings_of(const Setup &setup) {
  Findings findings{setup.start.scene.triangles.size(),
                    setup.start.scene.discs.size(),
                    setup.shadows,
                    shadow_casters(setup),
                    {},
                    {},
                    {},
                    setup.frames,
                    setup.motion != nullptr};
  DiagramAngles known_sr;
  for (const Illuminator &illuminator : setup.start.illuminators) {
    const LightFindings light = findings_of_light(illuminator, known_sr);
    findings.light.diodes += light.diodes;
    findings.light.intensity_w_sr += light.intensity_w_sr;
    findings.light.power_w += light.power_w;
    findings.illuminators.emplace_back(illuminator.name, light);
  }
  for (const Sensor &sensor : setup.start.sensors)
    findings.sensors.push_back(findings_of_sensor(setup, sensor));
  return findings;
}

std::vector<std::string> warnings_of(const Findings &findings) {
  std::vector<std::string> warnings;
  if (findings.triangles + findings.points > 0)
    for (const SensorFindings &sensor : findings.sensors)
      add_warnings(warnings, sensor);
  for (const SensorFindings &sensor : findings.sensors)
    add_tap_warning(warnings, sensor, findings.frames);
  return warnings;
}

std::optional<double> common_ambiguity_m(const std::vector<double> &modulation_hz) {
  std::uint64_t divisor_hz = 0;
  for (const double frequency_hz : modulation_hz) {
    if (frequency_hz != std::floor(frequency_hz))
      return std::nullopt;
    divisor_hz = std::gcd(divisor_hz, static_cast<std::uint64_t>(frequency_hz));
  }
  return speed_of_light_m_s / (2.0 * static_cast<double>(divisor_hz));
}

} // namespace pmdsim
