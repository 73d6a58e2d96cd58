#include "engine/reference/reference.h"
#include "host/commands/coarser_sensor.h"
#include "host/commands/commands.h"
#include "host/commands/loaded_setup.h"
#include "host/commands/report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <numeric>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr double view_columns = 64.0; // rays that look for what is visible, along the frame's longer side

// Distances from the lens; NaN where nothing is visible.
struct VisibleRange {
  double min_m = std::numeric_limits<double>::quiet_NaN();
  double max_m = std::numeric_limits<double>::quiet_NaN();

  bool is_empty() const { return std::isnan(min_m); }
};

// Figures that follow from a setup, lengths in metres.
struct Findings {
  std::size_t triangles, diodes;
  double intensity_w_sr; // of all diodes together, each on its axis
  double ambiguity_m, image_distance_m;
  glm::dvec2 field_of_view_deg; // full angles, along the columns and the rows
  glm::dvec2 footprint_at_1m_m; // of a pixel on a plane across the axis
  VisibleRange visible;
};

// By a coarse frame of the reference, which needs no device.
VisibleRange visible_range(const Setup &setup) {
  const Sensor &fine = setup.sensors.front();
  Sensor sensor = coarser(fine, std::max(fine.resolution.x, fine.resolution.y) / view_columns);
  sensor.samples = 1;
  const reference::Frame frame = reference::simulate(
      setup.scene, sensor, monostatic_illuminator(sensor.world_from_camera), setup.backscatter);
  VisibleRange range;
  for (const double range_m : frame.range_m) {
    range.min_m = std::fmin(range.min_m, range_m);
    range.max_m = std::fmax(range.max_m, range_m);
  }
  return range;
}

Findings findings_of(const Setup &setup) {
  const Sensor &sensor = setup.sensors.front();
  const std::vector<Diode> &diodes = setup.illuminators.front().diodes;
  const auto add_intensity = [](double sum, const Diode &diode) { return sum + diode.intensity_w_sr; };
  const double image_distance_m = sensor.image_distance_m();
  const glm::dvec2 half_chip_m = 0.5 * glm::dvec2(sensor.resolution) * sensor.pixel_pitch_m;
  return {.triangles = setup.scene.triangles.size(),
          .diodes = diodes.size(),
          .intensity_w_sr = std::accumulate(diodes.begin(), diodes.end(), 0.0, add_intensity),
          .ambiguity_m = sensor.ambiguity_m(),
          .image_distance_m = image_distance_m,
          .field_of_view_deg = 2.0 * glm::degrees(glm::atan(half_chip_m / image_distance_m)),
          .footprint_at_1m_m = sensor.pixel_pitch_m / image_distance_m,
          .visible = visible_range(setup)};
}

// Beyond what loading the setup has warned of already.
std::vector<std::string> warnings_of(const Findings &findings) {
  std::vector<std::string> warnings;
  if (findings.triangles > 0 && findings.visible.is_empty())
    warnings.emplace_back("no ray of a coarse frame hits the scene; is the camera turned away, or are the "
                          "scene's back faces culled?");
  if (findings.visible.max_m >= findings.ambiguity_m)
    warnings.push_back(fmt::format(
        "what is visible reaches {:.6g} m, beyond the ambiguity range of {:.6g} m: distances wrap",
        findings.visible.max_m, findings.ambiguity_m));
  return warnings;
}

ordered_json report_json(const Setup &setup, const Findings &findings) {
  std::vector<std::string> warnings = setup.warnings;
  std::ranges::copy(warnings_of(findings), std::back_inserter(warnings));
  return {{"triangles", findings.triangles},
          {"diodes", findings.diodes},
          {"intensity_w_sr", findings.intensity_w_sr},
          {"ambiguity_m", findings.ambiguity_m},
          {"image_distance_m", findings.image_distance_m},
          {"field_of_view_deg", {findings.field_of_view_deg.x, findings.field_of_view_deg.y}},
          {"pixel_footprint_at_1m_m", {findings.footprint_at_1m_m.x, findings.footprint_at_1m_m.y}},
          {"visible_range_m", {findings.visible.min_m, findings.visible.max_m}},
          {"warnings", warnings}};
}

std::string visible_text(const VisibleRange &range) {
  return range.is_empty() ? "nothing"
                          : fmt::format("{:.4g} m to {:.4g} m from the lens", range.min_m, range.max_m);
}

std::string report_text(const Setup &setup, const Findings &findings) {
  const Sensor &sensor = setup.sensors.front();
  std::string text = fmt::format("{} is valid\n\n", setup.file.string());
  const auto add = [&](const char *name, const std::string &value) {
    text += fmt::format("{:<25}{}\n", name, value);
  };
  add("triangles", fmt::format("{}", findings.triangles));
  add("visible", visible_text(findings.visible));
  add("diodes", fmt::format("{}, {:.6g} W/sr together", findings.diodes, findings.intensity_w_sr));
  add("resolution", fmt::format("{} x {}, {} x {} samples a pixel", sensor.resolution.x, sensor.resolution.y,
                                sensor.samples, sensor.samples));
  add("field of view",
      fmt::format("{:.3f}° x {:.3f}°", findings.field_of_view_deg.x, findings.field_of_view_deg.y));
  add("pixel footprint at 1 m", fmt::format("{:.4g} mm x {:.4g} mm", 1e3 * findings.footprint_at_1m_m.x,
                                            1e3 * findings.footprint_at_1m_m.y));
  add("image distance", fmt::format("{:.6g} mm", 1e3 * findings.image_distance_m));
  add("modulation", fmt::format("{:.6g} MHz", 1e-6 * sensor.modulation_hz[0]));
  add("ambiguity range", fmt::format("{:.6g} m", findings.ambiguity_m));
  return text;
}

} // namespace

void run_check(const Options &options) {
  const Setup setup = load_for_command(options);
  const Findings findings = findings_of(setup);
  for (const std::string &warning : warnings_of(findings))
    fmt::print(stderr, "pmdsim: warning: {}\n", warning);
  if (options.json)
    print(report_json(setup, findings));
  else
    print(report_text(setup, findings));
}

} // namespace pmdsim
