#include "host/input/setup/plausibility.h"

#include "engine/lens/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double least_view_deg = 0.1, largest_view_deg = 179.0;
constexpr double longest_focal_length_m = 1.0; // of a camera
constexpr std::uint32_t least_columns = 16;    // of an image: fewer may see so little on purpose
constexpr double largest_body_m = 1.0;         // of a body that shows both sides
constexpr double largest_over_ambiguity = 100; // a scene's size: more means another unit
constexpr std::size_t most_diodes_looked_at = 1000;

// The wider of the angles that the image spans, if the lens has no distortion.
double view_deg(const Sensor &sensor) {
  const glm::dvec2 size_m = sensor.pixel_pitch_m * glm::dvec2(sensor.resolution);
  const double half = std::max(size_m.x, size_m.y) / (2.0 * sensor.image_distance_m());
  const bool is_fisheye = std::holds_alternative<Fisheye>(sensor.distortion);
  return (is_fisheye ? half : std::atan(half)) * 2.0 / std::numbers::pi * 180.0;
}

// Whether a length of that sensor is doubted already.
bool is_doubted(const Setup &setup, std::size_t sensor) {
  const std::string key = fmt::format("/sensors/{}/", sensor);
  return std::ranges::any_of(setup.warnings, [&](const Warning &warning) {
    return warning.code == "unusual-value" && warning.place.find(key) != std::string::npos;
  });
}

void add_views(const Setup &setup, const Place &root, std::vector<Warning> &warnings) {
  for (std::size_t i = 0; i < setup.start.sensors.size(); ++i) {
    const Sensor &sensor = setup.start.sensors[i];
    const double angle_deg = view_deg(sensor);
    const bool is_fisheye = std::holds_alternative<Fisheye>(sensor.distortion);
    const bool is_image = std::max(sensor.resolution.x, sensor.resolution.y) >= least_columns ||
                          sensor.focal_length_m > longest_focal_length_m;
    const bool is_narrow = angle_deg < least_view_deg && is_image;
    if ((!is_narrow && (angle_deg <= largest_view_deg || is_fisheye)) || is_doubted(setup, i))
      continue;
    warnings.push_back(input_warning(
        warning_code("field-of-view"), root / "sensors" / i / "focal_length_m",
        fmt::format("sensor {} sees {:.3g} degrees, by a focal length of {:g} m and {} pixels of {:g} m: is "
                    "one of them in millimetres? All lengths are metres",
                    sensor.name, angle_deg, sensor.focal_length_m,
                    std::max(sensor.resolution.x, sensor.resolution.y),
                    std::max(sensor.pixel_pitch_m.x, sensor.pixel_pitch_m.y))));
  }
}

double largest_ambiguity_m(const Setup &setup) {
  double largest_m = 0.0;
  for (const Sensor &sensor : setup.start.sensors)
    for (std::size_t i = 0; i < sensor.modulation_hz.size(); ++i)
      largest_m = std::max(largest_m, sensor.ambiguity_m(i));
  return largest_m;
}

// Whether any lens has a vertex within its reach, or a flat scene, whose triangles may be large, does.
bool is_any_near(const Setup &setup, const glm::dvec3 &min_m, const glm::dvec3 &max_m, double reach_m) {
  const glm::dvec3 size_m = max_m - min_m;
  const bool is_flat = std::min({size_m.x, size_m.y, size_m.z}) < reach_m;
  return std::ranges::any_of(setup.start.sensors, [&](const Sensor &sensor) {
    const glm::dvec3 &lens_m = sensor.world_from_camera.translation_m;
    if (is_flat && glm::distance(lens_m, glm::clamp(lens_m, min_m, max_m)) < reach_m)
      return true;
    return std::ranges::any_of(setup.start.scene.positions_m, [&](const glm::dvec3 &vertex_m) {
      return glm::distance(lens_m, vertex_m) < reach_m;
    });
  });
}

void add_unit(const Setup &setup, const Place &root, std::vector<Warning> &warnings) {
  const std::vector<glm::dvec3> &vertices_m = setup.start.scene.positions_m;
  if (vertices_m.empty())
    return;
  glm::dvec3 min_m = vertices_m.front(), max_m = min_m;
  for (const glm::dvec3 &vertex_m : vertices_m) {
    min_m = glm::min(min_m, vertex_m);
    max_m = glm::max(max_m, vertex_m);
  }
  const glm::dvec3 size_m = max_m - min_m;
  const double longest_m = std::max({size_m.x, size_m.y, size_m.z}), reach_m = largest_ambiguity_m(setup);
  if (longest_m < largest_over_ambiguity * reach_m || is_any_near(setup, min_m, max_m, reach_m))
    return;
  warnings.push_back(input_warning(
      warning_code("scene-in-millimetres"), root / "scene",
      fmt::format(
          "the scene is {:.4g} m long and nothing of it within the {:.4g} m that are measured without "
          "ambiguity: are its lengths millimetres? glTF's are metres; put all root nodes below one node of "
          "scale 0.001 (in Blender: select all, scale by 0.001 about the origin, apply the scale, export)",
          longest_m, reach_m)));
}

// Whether a diode shines into its front half-space alone.
bool shines_forward_only(const Pattern &pattern) {
  if (pattern.kind == Pattern::Kind::diagram)
    return pattern.diagram->theta_rad.back() <= std::numbers::pi / 2.0;
  return pattern.kind == Pattern::Kind::cosine;
}

// The rays of the image's corners and centre, world frame; empty where one is missing.
std::vector<glm::dvec3> view_rays(const Sensor &sensor) {
  const Lens lens(sensor);
  const glm::dvec2 size(sensor.resolution);
  std::vector<glm::dvec3> rays;
  for (const glm::dvec2 part :
       {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1), glm::dvec2(0.5)}) {
    const auto ray = lens.ray(lens.on_chip_m(part * size));
    if (!ray)
      return {};
    rays.push_back(sensor.world_from_camera.direction(*ray));
  }
  return rays;
}

// Whether nothing that lies along the rays from the lens, however far, is before the diode.
bool is_turned_away(const Diode &diode, const Pose &world_from_illuminator, const glm::dvec3 &lens_m,
                    const std::vector<glm::dvec3> &rays) {
  if (diode.intensity_w_sr == 0.0)
    return true;
  if (!shines_forward_only(diode.pattern))
    return false;
  const glm::dvec3 axis = world_from_illuminator.direction(diode.axis);
  const glm::dvec3 from_diode_m = lens_m - world_from_illuminator.point(diode.position_m);
  const double longest_m = glm::length(from_diode_m), ahead_m = glm::dot(from_diode_m, axis);
  constexpr double rounding = 1e-9;
  return ahead_m <= rounding * longest_m &&
         std::ranges::all_of(rays, [&](const glm::dvec3 &ray) { return glm::dot(ray, axis) <= rounding; });
}

void add_turned_away(const Setup &setup, std::vector<Warning> &warnings) {
  for (const Sensor &sensor : setup.start.sensors) {
    const std::vector<glm::dvec3> rays = view_rays(sensor);
    const auto is_away = [&](const Illuminator &illuminator) {
      return std::ranges::all_of(illuminator.diodes, [&](const Diode &diode) {
        return is_turned_away(diode, illuminator.world_from_illuminator,
                              sensor.world_from_camera.translation_m, rays);
      });
    };
    if (!rays.empty() && std::ranges::all_of(setup.start.illuminators, is_away))
      warnings.push_back({warning_code("diodes-turned-away"), "sensor " + sensor.name,
                          fmt::format("all {} diodes are turned away from what it sees, or dark: turn the "
                                      "illuminators' poses or the diodes' axes, +z of an illuminator is "
                                      "forward",
                                      diode_count(setup.start.illuminators))});
  }
}

// Their places, evenly chosen where there are very many.
std::vector<glm::dvec3> places_of(const Illuminator &illuminator) {
  const std::size_t step = 1 + illuminator.diodes.size() / most_diodes_looked_at;
  std::vector<glm::dvec3> places_m;
  for (std::size_t i = 0; i < illuminator.diodes.size(); i += step)
    places_m.push_back(illuminator.world_from_illuminator.point(illuminator.diodes[i].position_m));
  return places_m;
}

void add_lenses_in_bodies(const Setup &setup, const std::vector<std::uint32_t> &around,
                          std::vector<Warning> &warnings) {
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around[i] != no_id)
      warnings.push_back({warning_code("sensor-inside-body"), "sensor " + setup.start.sensors[i].name,
                          fmt::format("its lens lies inside the body {}, which closes around it: move the "
                                      "sensor or the body",
                                      in_quotes(setup.start.scene.objects[around[i]]))});
}

// Where in the setup an illuminator stands, among those of other cameras.
Place place_of(const Illuminator &illuminator, const Setup &setup, const Place &root) {
  const nlohmann::ordered_json &all = setup.as_used.at("illuminators");
  const auto found = std::ranges::find_if(
      all, [&](const nlohmann::ordered_json &each) { return each.at("name") == illuminator.name; });
  return root / "illuminators" / static_cast<std::size_t>(found - all.begin());
}

// A body that is around a lens, too, is told of once.
void add_diodes_in_bodies(const Setup &setup, const Place &root, const std::vector<std::uint32_t> &lenses,
                          std::vector<Warning> &warnings) {
  for (const Illuminator &illuminator : setup.start.illuminators) {
    std::vector<std::uint32_t> around =
        bodies_around(setup.start.scene, places_of(illuminator), largest_body_m);
    const std::size_t count = around.size();
    std::erase_if(around, [&](std::uint32_t body) {
      return body == no_id || std::ranges::find(lenses, body) != lenses.end();
    });
    if (!around.empty())
      warnings.push_back(input_warning(
          warning_code("diode-inside-body"), place_of(illuminator, setup, root),
          fmt::format("{} of {} diodes lie inside the body {}, which keeps their light: move the illuminator "
                      "or the body, or leave the body out",
                      around.size(), count, in_quotes(setup.start.scene.objects[around.front()]))));
  }
}

void add_bodies(const Setup &setup, const Place &root, std::vector<Warning> &warnings) {
  std::vector<glm::dvec3> lenses_m;
  for (const Sensor &sensor : setup.start.sensors)
    lenses_m.push_back(sensor.world_from_camera.translation_m);
  const std::vector<std::uint32_t> around = bodies_around(setup.start.scene, lenses_m, largest_body_m);
  add_lenses_in_bodies(setup, around, warnings);
  if (setup.shadows == Shadows::automatic)
    add_diodes_in_bodies(setup, root, around, warnings);
}

} // namespace

std::vector<Warning> implausibilities(const Setup &setup, const Place &root) {
  std::vector<Warning> warnings;
  add_views(setup, root, warnings);
  add_unit(setup, root, warnings);
  add_turned_away(setup, warnings);
  add_bodies(setup, root, warnings);
  return warnings;
}

} // namespace pmdsim
