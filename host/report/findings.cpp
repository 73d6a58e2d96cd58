#include "host/report/findings.h"

#include "engine/lens/lens.h"
#include "engine/model/tap_sequence.h"
#include "engine/reference/reference.h"
#include "host/report/coarse_view.h"
#include "host/report/report.h"
#include "host/report/view_warnings.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <numeric>

namespace pmdsim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Places count columns and rows from the image's top left corner.
class Image {
public:
  explicit Image(const Sensor &sensor) : lens_(sensor), size_(sensor.resolution) {}

  // `part` of the image's width and height.
  glm::dvec2 place(const glm::dvec2 &part) const { return part * size_; }
  // Unit length, or NaN.
  glm::dvec3 ray(const glm::dvec2 &place) const {
    return lens_.ray(lens_.on_chip_m(place)).value_or(glm::dvec3(nan));
  }
  // The angle from `part` over the centre to the place opposite.
  double angle_across_deg(const glm::dvec2 &part) const {
    const glm::dvec3 centre = ray(place(glm::dvec2(0.5)));
    return angle_deg(ray(place(part)), centre) + angle_deg(centre, ray(place(1.0 - part)));
  }

private:
  // Precise for small angles too, as an arc cosine is not.
  static double angle_deg(const glm::dvec3 &a, const glm::dvec3 &b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
  }

  Lens lens_;
  glm::dvec2 size_;
};

// The distance between where the rays through two places meet the plane z = 1 m.
double distance_at_1m_m(const Image &image, const glm::dvec2 &from, const glm::dvec2 &to) {
  const glm::dvec3 a = image.ray(from), b = image.ray(to);
  return a.z > 0.0 && b.z > 0.0 ? glm::distance(a / a.z, b / b.z) : nan;
}

double darkest_corner(const Image &image, Vignetting vignetting) {
  if (vignetting == Vignetting::none)
    return 1.0;
  double darkest = 1.0;
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)})
    darkest = std::min(darkest, std::pow(std::max(0.0, image.ray(image.place(corner)).z), 4.0));
  return darkest;
}

// 0 where nothing is visible.
double share_beyond(const std::vector<double> &ranges_m, double ambiguity_m) {
  const auto beyond = std::ranges::count_if(ranges_m, [&](double range_m) { return range_m >= ambiguity_m; });
  return ranges_m.empty() ? 0.0 : static_cast<double>(beyond) / static_cast<double>(ranges_m.size());
}

SensorFindings findings_of_sensor(const Setup &setup, const Sensor &sensor,
                                  const std::vector<double> &ranges_m) {
  SensorFindings findings{sensor, field_of_view(sensor), {}, {}, electron_findings(setup, sensor)};
  if (!ranges_m.empty())
    findings.visible = {std::ranges::min(ranges_m), std::ranges::max(ranges_m)};
  for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
    findings.shares_beyond.push_back(share_beyond(ranges_m, sensor.ambiguity_m(i)));
  return findings;
}

// Many diodes share a diagram.
using DiagramAngles = std::map<const Diagram *, double>;

double known_or_new_sr(const Pattern &pattern, DiagramAngles &known_sr) {
  if (!pattern.diagram)
    return reference::solid_angle_sr(pattern);
  double &known = known_sr[pattern.diagram.get()];
  if (known == 0.0)
    known = reference::solid_angle_sr(pattern);
  return known;
}

LightFindings findings_of_light(const Illuminator &illuminator, DiagramAngles &known_sr) {
  LightFindings light{illuminator.diodes.size()};
  for (const Diode &diode : illuminator.diodes) {
    light.intensity_w_sr += diode.intensity_w_sr;
    light.power_w += diode.intensity_w_sr * known_or_new_sr(diode.pattern, known_sr);
  }
  return light;
}

void add_view_warnings(std::vector<Warning> &warnings, const Setup &setup, std::size_t number,
                       const SensorFindings &findings) {
  const Sensor &sensor = findings.sensor;
  const VisibleRange &visible = findings.visible;
  if (visible.is_empty())
    warnings.push_back(
        nothing_in_view(setup, sensor, fmt::format("{}: /sensors/{}/pose", setup.file.string(), number)));
  for (std::size_t i = 0; i < findings.shares_beyond.size(); ++i)
    if (findings.shares_beyond[i] > 0.0 && !(sensor.unwrap_range_m >= visible.max_m))
      warnings.push_back(beyond_ambiguity(
          setup, {visible.min_m, visible.max_m, findings.shares_beyond[i], sensor.ambiguity_m(i)},
          fmt::format("{} at {}", place_of(sensor), frequency_text(sensor.modulation_hz[i]))));
}

void add_tap_warning(std::vector<Warning> &warnings, const Sensor &sensor, const FrameTimes &frames) {
  constexpr double rounding = 1e-9;
  const double frame_s = 1.0 / frames.rate_hz, taps_s = tap_sequence_s(sensor);
  if (frames.count > 1 && taps_s > frame_s * (1.0 + rounding))
    warnings.push_back(
        {warning_code("frames-overlap"), place_of(sensor),
         fmt::format("its taps take {:.6g} s, longer than the {:.6g} s from one frame to the "
                     "next: frames overlap; a shorter tap_interval_s or a lower rate_hz parts them",
                     taps_s, frame_s)});
}

// No shape stands in its own light.
std::size_t shadow_casters(const Setup &setup) {
  const std::size_t shapes = setup.start.scene.shape_count();
  return setup.shadows == Shadows::automatic && shapes > 1 ? shapes : 0;
}

} // namespace

FieldOfView field_of_view(const Sensor &sensor) {
  const Image image(sensor);
  const glm::dvec2 centre = image.place(glm::dvec2(0.5)), column(0.5, 0.0), row(0.0, 0.5);
  return {image.angle_across_deg({0.0, 0.5}),
          image.angle_across_deg({0.5, 0.0}),
          std::fmax(image.angle_across_deg({0.0, 0.0}), image.angle_across_deg({0.0, 1.0})),
          {distance_at_1m_m(image, centre - column, centre + column),
           distance_at_1m_m(image, centre - row, centre + row)},
          darkest_corner(image, sensor.vignetting)};
}

glm::dvec2 view_of_camera_deg(const GltfPerspective &camera, const Sensor &sensor) {
  const glm::dvec2 size_m = sensor.pixel_pitch_m * glm::dvec2(sensor.resolution);
  const double ratio = camera.width_to_height.value_or(size_m.x / size_m.y);
  return glm::degrees(
      glm::dvec2(2.0 * std::atan(ratio * std::tan(0.5 * camera.vertical_rad)), camera.vertical_rad));
}

std::optional<double> focal_length_like(const GltfPerspective &camera, const Sensor &sensor) {
  if (std::holds_alternative<Fisheye>(sensor.distortion))
    return std::nullopt;
  const double width_m = sensor.pixel_pitch_m.x * sensor.resolution.x;
  const double half_rad = 0.5 * glm::radians(view_of_camera_deg(camera, sensor).x);
  const double image_distance_m = 0.5 * width_m / std::tan(half_rad);
  return 1.0 / (1.0 / sensor.focus_distance_m + 1.0 / image_distance_m); // of the thin lens
}

Sensor coarser(Sensor sensor, double factor) {
  if (factor <= 1.0)
    return sensor;
  const glm::uvec2 fewest = glm::min(sensor.resolution, glm::uvec2(8));
  const glm::uvec2 resolution = glm::max(glm::uvec2(glm::dvec2(sensor.resolution) / factor), fewest);
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(resolution);
  sensor.resolution = resolution;
  return sensor;
}

Findings findings_of(const Setup &setup) {
  Findings findings{shadow_casters(setup)};
  DiagramAngles known_sr;
  for (const Illuminator &illuminator : setup.start.illuminators) {
    const LightFindings light = findings_of_light(illuminator, known_sr);
    findings.light.diodes += light.diodes;
    findings.light.intensity_w_sr += light.intensity_w_sr;
    findings.light.power_w += light.power_w;
    findings.illuminators.emplace_back(illuminator.name, light);
  }
  std::vector<glm::dvec3> seen_m;
  for (const Sensor &sensor : setup.start.sensors) {
    const CoarseView view = coarse_view(setup, sensor);
    findings.sensors.push_back(findings_of_sensor(setup, sensor, view.ranges_m));
    std::ranges::copy(view.points_m, std::back_inserter(seen_m));
  }
  for (const Illuminator &illuminator : setup.start.illuminators)
    findings.boards.push_back(board_findings(setup, illuminator, seen_m));
  return findings;
}

std::vector<Warning> warnings_of(const Setup &setup, const Findings &findings) {
  std::vector<Warning> warnings;
  if (setup.start.scene.shape_count() > 0)
    for (std::size_t i = 0; i < findings.sensors.size(); ++i)
      add_view_warnings(warnings, setup, i, findings.sensors[i]);
  for (std::size_t i = 0; i < findings.boards.size(); ++i)
    if (const auto away = turned_away_warning(setup, i, findings.boards[i]))
      warnings.push_back(*away);
  for (const SensorFindings &sensor : findings.sensors) {
    add_tap_warning(warnings, sensor.sensor, setup.frames);
    if (sensor.electrons)
      if (const auto full = full_warning(sensor.sensor, *sensor.electrons))
        warnings.push_back(*full);
  }
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
