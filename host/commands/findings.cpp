#include "host/commands/findings.h"

#include "engine/reference/reference.h"
#include "engine/tap_sequence.h"
#include "host/commands/coarser_sensor.h"
#include "host/commands/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
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

} // namespace

Findings findings_of(const Setup &setup) {
  const std::vector<Diode> &diodes = setup.start.illuminators.front().diodes;
  Findings findings{
      setup.start.scene.triangles.size(), diodes.size(), 0.0, 0.0, {}, setup.frames, setup.motion != nullptr};
  for (const Diode &diode : diodes) {
    findings.intensity_w_sr += diode.intensity_w_sr;
    findings.power_w += diode_power_w(diode);
  }
  for (const Sensor &sensor : setup.start.sensors)
    findings.sensors.push_back(findings_of_sensor(setup, sensor));
  return findings;
}

std::vector<std::string> warnings_of(const Findings &findings) {
  std::vector<std::string> warnings;
  if (findings.triangles > 0)
    for (const SensorFindings &sensor : findings.sensors)
      add_warnings(warnings, sensor);
  for (const SensorFindings &sensor : findings.sensors)
    add_tap_warning(warnings, sensor, findings.frames);
  return warnings;
}

double diode_power_w(const Diode &diode) {
  const double solid_angle_sr = diode.pattern.kind == Pattern::Kind::isotropic
                                    ? 4.0 * std::numbers::pi
                                    : 2.0 * std::numbers::pi / (diode.pattern.order + 1.0);
  return solid_angle_sr * diode.intensity_w_sr;
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
