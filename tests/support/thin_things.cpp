#include "tests/support/thin_things.h"

#include "engine/lens/lens.h"
#include "tests/support/scenes.h"

#include <cmath>
#include <numbers>

namespace pmdsim::test {

namespace {

struct PlaceInView {
  glm::dvec3 ray; // unit length
  double range_m;
  double sample_m; // how far the rays of neighbouring samples lie apart there
};

PlaceInView place_in_view(Random &random, const Sensor &sensor) {
  const Lens lens(sensor);
  const glm::dvec2 pixel(random.uniform(0, sensor.resolution.x), random.uniform(0, sensor.resolution.y));
  const glm::dvec3 ray = *lens.ray(lens.on_chip_m(pixel));
  const double range_m = random.uniform(1.0, 2.5);
  const double step_pixels = pixel.x < 1.0 ? 0.5 : -0.5; // within the image
  const glm::dvec3 beside = *lens.ray(lens.on_chip_m(pixel + glm::dvec2(step_pixels, 0)));
  return {ray, range_m, range_m * 2.0 * glm::length(beside - ray) / sensor.samples};
}

} // namespace

Scene rods_in_view(Random &random, std::size_t count, double width_samples, const Sensor &sensor) {
  SceneBuilder builder(sensor.world_from_camera);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [ray, range_m, sample_m] = place_in_view(random, sensor);
    const glm::dvec3 centre_m = range_m * ray;
    const glm::dvec3 along = glm::normalize(glm::cross(ray, random.unit_vector()));
    const glm::dvec3 half_m = 0.5 * random.uniform(20, 120) * sample_m * along;
    const glm::dvec3 aside_m = 0.5 * width_samples * sample_m * glm::cross(ray, along);
    builder.add_mesh({centre_m - half_m - aside_m, centre_m + half_m - aside_m, centre_m + half_m + aside_m,
                      centre_m - half_m + aside_m},
                     {{0, 1, 2}, {0, 2, 3}}, {random.uniform(0.2, 1.0), true});
  }
  return builder.scene();
}

Scene points_in_view(Random &random, std::size_t count, double diameter_samples, const Sensor &sensor) {
  Scene scene;
  scene.surfaces = {{0.8, false}};
  scene.objects = {"points"};
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto [ray, range_m, sample_m] = place_in_view(random, sensor);
    scene.positions_m.push_back(sensor.world_from_camera.point(range_m * ray));
    scene.discs.push_back({i, 0.5 * diameter_samples * sample_m, 0, 0});
  }
  return scene;
}

Scene grass(Random &random, std::size_t blades, const Sensor &sensor) {
  SceneBuilder builder(sensor.world_from_camera);
  builder.add_mesh({{-5, 0.9, 0.5}, {5, 0.9, 0.5}, {5, 0.9, 6}, {-5, 0.9, 6}}, {{0, 1, 2}, {0, 2, 3}},
                   {0.3, true});
  for (std::size_t i = 0; i < blades; ++i) {
    const double z_m = random.uniform(1, 5), x_m = random.uniform(-0.6, 0.6) * z_m;
    const double turn_rad = random.uniform(0, std::numbers::pi);
    const glm::dvec3 root_m(x_m, 0.9, z_m),
        half_m = random.uniform(1e-3, 4e-3) * glm::dvec3(std::cos(turn_rad), 0, std::sin(turn_rad));
    const glm::dvec3 tip_m =
        root_m + glm::dvec3(random.uniform(-0.1, 0.1), -random.uniform(0.2, 0.5), random.uniform(-0.1, 0.1));
    builder.add_triangle(root_m - half_m, root_m + half_m, tip_m, {random.uniform(0.2, 0.9), true});
  }
  return builder.scene();
}

} // namespace pmdsim::test
