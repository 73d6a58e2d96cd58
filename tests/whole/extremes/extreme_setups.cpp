#include "tests/whole/extremes/extreme_setups.h"

#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pmdsim::test {

namespace {

constexpr int squares_a_side = 14;         // of the wall of small triangles
constexpr double squares_in_half_view = 6; // fewer than half of them, so that they fill it
constexpr double widest_half_view = 0.25;  // slope of the view's border
constexpr double most_paths = 2e6;         // light paths in a frame, so that the reference is quick
constexpr double focal_length_m = 0.1;
const Surface wall_surface{0.7, true};

// Slopes of the view's borders along columns and rows. Towards grazing incidence it shrinks with the angle
// that is left, so that all of it meets the wall at 2/3 to 2 times its distance.
glm::dvec2 half_view(const ExtremeSetup &setup) {
  glm::dvec2 half(widest_half_view);
  if (setup.incidence_deg > 0.0)
    half = glm::dvec2(std::min(widest_half_view, 0.5 / std::tan(setup.incidence_deg * degree)));
  if (setup.triangle_m > 0.0)
    half = glm::min(half, squares_in_half_view * setup.triangle_m * glm::dvec2(setup.aspect, 1.0) /
                              setup.distance_m);
  return half;
}

std::uint32_t pixels_a_side(const ExtremeSetup &setup) {
  const double paths_a_pixel = static_cast<double>(setup.samples * setup.samples) * setup.diodes;
  return static_cast<std::uint32_t>(std::clamp(std::sqrt(most_paths / paths_a_pixel), 2.0, 24.0));
}

Sensor sensor_of(const ExtremeSetup &setup) {
  Sensor sensor;
  sensor.resolution = glm::uvec2(pixels_a_side(setup));
  sensor.focal_length_m = focal_length_m;
  sensor.pixel_pitch_m = 2.0 * focal_length_m * half_view(setup) / glm::dvec2(sensor.resolution);
  sensor.samples = setup.samples;
  sensor.modulation_hz = {setup.modulation_hz};
  sensor.world_from_camera = {Random(1).pose(0.0).rotation, setup.offset_m * glm::dvec3(1.0, -0.7, 0.4)};
  return sensor;
}

// Axes in the wall: u along the columns, leaning away from the lens, and v along the rows.
struct WallAxes {
  glm::dvec3 u, v, normal; // the normal towards the lens

  explicit WallAxes(double incidence_deg)
      : u(std::cos(incidence_deg * degree), 0.0, std::sin(incidence_deg * degree)), v(0.0, 1.0, 0.0),
        normal(std::sin(incidence_deg * degree), 0.0, -std::cos(incidence_deg * degree)) {}
};

// Its diagonal does not pass through the middle of the view, where samples would lie on it.
void add_large_wall(SceneBuilder &builder, const glm::dvec3 &centre_m, const WallAxes &axes, double half_m) {
  const glm::dvec3 middle_m = centre_m + 0.13 * half_m * axes.u;
  const glm::dvec3 u_m = half_m * axes.u, v_m = half_m * axes.v;
  builder.add_mesh({middle_m - u_m - v_m, middle_m - u_m + v_m, middle_m + u_m + v_m, middle_m + u_m - v_m},
                   {{0, 1, 2}, {0, 2, 3}}, wall_surface);
}

// Not symmetric about the optical axis, so that no sample lies on an edge.
void add_fine_wall(SceneBuilder &builder, const glm::dvec3 &centre_m, const WallAxes &axes,
                   const ExtremeSetup &setup) {
  const glm::dvec3 u_m = setup.triangle_m * setup.aspect * axes.u, v_m = setup.triangle_m * axes.v;
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t i = 0; i <= squares_a_side; ++i)
    for (std::uint32_t j = 0; j <= squares_a_side; ++j) {
      corners_m.push_back(centre_m + (j - 0.5 * squares_a_side + 0.13) * u_m +
                          (i - 0.5 * squares_a_side + 0.07) * v_m);
      const std::uint32_t a = i * (squares_a_side + 1) + j, b = a + squares_a_side + 1;
      if (i == squares_a_side || j == squares_a_side)
        continue;
      faces.insert(faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
      if (setup.zero_areas) // a point, an edge, and three corners in a line
        faces.insert(faces.end(), {{a, a, a}, {a, b, a}, {a - j, a, a - j + squares_a_side}});
    }
  builder.add_mesh(corners_m, faces, wall_surface);
}

Scene scene_of(const ExtremeSetup &setup, const Sensor &sensor) {
  SceneBuilder builder(sensor.world_from_camera);
  const glm::dvec3 centre_m(0.0, 0.0, setup.distance_m);
  const WallAxes axes(setup.incidence_deg);
  if (setup.triangle_m > 0.0)
    add_fine_wall(builder, centre_m, axes, setup);
  else
    add_large_wall(builder, centre_m, axes, 2.0 * setup.distance_m);
  return builder.scene();
}

// Evenly over the view, the first right before where a sample sees the wall.
glm::dvec3 place_before_wall(const ExtremeSetup &setup, std::uint32_t k, const Sensor &sensor) {
  const WallAxes axes(setup.incidence_deg);
  const double golden_angle = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const double reach = 0.8 * std::sqrt(static_cast<double>(k) / setup.diodes);
  const glm::dvec2 half_pixel = half_view(setup) / glm::dvec2(sensor.resolution * sensor.samples);
  const glm::dvec2 slope =
      half_pixel +
      reach * half_view(setup) * glm::dvec2(std::cos(golden_angle * k), std::sin(golden_angle * k));
  const glm::dvec3 ray(slope, 1.0);
  const double offset_m = axes.normal.z * setup.distance_m;
  return offset_m / glm::dot(axes.normal, ray) * ray + setup.over_wall_m * axes.normal;
}

glm::dvec3 place_on_ring(const ExtremeSetup &setup, std::uint32_t k) {
  const double angle_rad = 2.0 * std::numbers::pi * (k + 0.5) / setup.diodes;
  return {setup.ring_radius_m * std::cos(angle_rad), setup.ring_radius_m * std::sin(angle_rad), 0.0};
}

Illuminator light_of(const ExtremeSetup &setup, const Sensor &sensor) {
  Illuminator illuminator{"light", sensor.world_from_camera, {}};
  for (std::uint32_t k = 0; k < setup.diodes; ++k) {
    Diode diode =
        diode_at(setup.over_wall_m > 0.0 ? place_before_wall(setup, k, sensor) : place_on_ring(setup, k));
    diode.intensity_w_sr = setup.intensity_w_sr;
    illuminator.diodes.push_back(diode);
  }
  return illuminator;
}

Illuminator opposed_light_of(const ExtremeSetup &setup, const Sensor &sensor) {
  const double half_wave_m = 0.5 * speed_of_light_m_s / setup.modulation_hz;
  const bool behind = setup.opposed == ExtremeSetup::Opposed::path;
  Illuminator illuminator{"opposed", sensor.world_from_camera, {}, behind ? 0.0 : std::numbers::pi};
  for (std::uint32_t k = 0; k < setup.diodes; ++k) {
    // From the wall's middle: the same direction, so that only distance changes what returns.
    const glm::dvec3 middle_m(0.0, 0.0, setup.distance_m), way_m = place_on_ring(setup, k) - middle_m;
    const double stretch = behind ? 1.0 + half_wave_m / glm::length(way_m) : 1.0;
    illuminator.diodes.push_back(diode_at(middle_m + stretch * way_m));
    illuminator.diodes.back().intensity_w_sr =
        setup.intensity_w_sr * (1.0 - setup.left_over) * stretch * stretch;
  }
  return illuminator;
}

// Whose light the wall turns its back to.
Illuminator light_behind_wall(const ExtremeSetup &setup, const Sensor &sensor) {
  Illuminator illuminator{"behind", sensor.world_from_camera, {}};
  for (std::uint32_t k = 0; k < setup.diodes; ++k) {
    const glm::dvec3 through_wall_m(0.0, 0.0, 2.0 * setup.distance_m);
    illuminator.diodes.push_back(diode_at(through_wall_m + place_on_ring(setup, k)));
    illuminator.diodes.back().intensity_w_sr = setup.behind_w_sr;
  }
  return illuminator;
}

} // namespace

BuiltSetup build(const ExtremeSetup &setup) {
  const Sensor sensor = sensor_of(setup);
  BuiltSetup built{scene_of(setup, sensor), sensor, {light_of(setup, sensor)}};
  if (setup.opposed != ExtremeSetup::Opposed::no)
    built.illuminators.push_back(opposed_light_of(setup, sensor));
  if (setup.behind_w_sr > 0.0)
    built.illuminators.push_back(light_behind_wall(setup, sensor));
  return built;
}

} // namespace pmdsim::test
