// Surfaces whose reflectivity varies, and surfaces with holes: a wall across the axis, light in the lens, so
// that the amplitude is rho / r^2 and the distance r.

#include "tests/comparison/engines.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr double wall_m = 2.0;

// 53 x 37 pixels, the wall from -0.6 to 0.6 m in both directions fills the image.
Sensor wall_sensor() {
  Sensor sensor;
  sensor.resolution = {53, 37};
  sensor.pixel_pitch_m = {1e-3, 1.3e-3};
  sensor.focal_length_m = 0.1;
  return sensor;
}

// Where a pixel's ray meets the wall.
glm::dvec2 on_wall_m(const Sensor &sensor, std::uint32_t column, std::uint32_t row) {
  const glm::dvec2 from_centre = glm::dvec2(column, row) + 0.5 - 0.5 * glm::dvec2(sensor.resolution);
  return from_centre * sensor.pixel_pitch_m / sensor.focal_length_m * wall_m;
}

// The wall's corners are upper left, lower left, lower right, upper right in the image.
Scene wall_with(const Surface &surface) {
  SceneBuilder builder;
  builder.add_wall({wall_m, surface, {-0.6, -0.6}, {0.6, 0.6}});
  return builder.scene();
}

// u and v run from -1.31 to 2.93 over the wall.
constexpr double first_uv = -1.31, last_uv = 2.93;

void give_texture_coordinates(Scene &scene) {
  scene.texture_coordinates = {
      {first_uv, first_uv}, {first_uv, last_uv}, {last_uv, last_uv}, {last_uv, first_uv}};
}

glm::dvec2 uv_of(const glm::dvec2 &p_m) { return first_uv + (last_uv - first_uv) * (p_m + 0.6) / 1.2; }

// 5 x 3 texels whose reflectivity grows by 0.05 from one to the next; alpha 0.1 more each.
Texture stairs() {
  Texture texture{{5, 3}, {}};
  for (int i = 0; i < 15; ++i)
    texture.texels.emplace_back(0.05f * static_cast<float>(i + 1), 0.9f, 0.3f,
                                0.06f * static_cast<float>(i + 1));
  return texture;
}

double stair(int column, int row) {
  return static_cast<double>(0.05f * static_cast<float>(5 * row + column + 1));
}

// glTF's samplers: the texel that a whole-numbered place outside 0 ... size - 1 stands for.
int folded(int texel, int size, Wrap wrap) {
  const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
  switch (wrap) {
  case Wrap::repeat:
    return modulo(texel, size);
  case Wrap::mirrored_repeat:
    return std::min(modulo(texel, 2 * size), 2 * size - 1 - modulo(texel, 2 * size));
  case Wrap::clamp:
    break;
  }
  return std::clamp(texel, 0, size - 1);
}

double stairs_at(const glm::dvec2 &uv, const Paint &paint) {
  const auto value = [&](int column, int row) {
    return stair(folded(column, 5, paint.wrap_u), folded(row, 3, paint.wrap_v));
  };
  const double s = uv.x * 5, t = uv.y * 3;
  if (paint.filter == TextureFilter::nearest)
    return value(static_cast<int>(std::floor(s)), static_cast<int>(std::floor(t)));
  const double column = std::floor(s - 0.5), row = std::floor(t - 0.5);
  const double x = s - 0.5 - column, y = t - 0.5 - row;
  const auto c = static_cast<int>(column), r = static_cast<int>(row);
  return (1 - y) * ((1 - x) * value(c, r) + x * value(c + 1, r)) +
         y * ((1 - x) * value(c, r + 1) + x * value(c + 1, r + 1));
}

// Checks amplitude and distance of every pixel against `rho`, of the place on the wall.
void check_wall(Engine engine, const std::string &name, const Scene &scene,
                const std::function<double(const glm::dvec2 &)> &rho, const SimulatorOptions &options = {}) {
  const Sensor sensor = wall_sensor();
  const Measurement measured = measure_monostatic(engine, scene, sensor, Backscatter::constant, options);
  double amplitude_error = 0.0, distance_error_m = 0.0;
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const glm::dvec2 p_m = on_wall_m(sensor, column, row);
      const double r2 = glm::dot(p_m, p_m) + wall_m * wall_m;
      const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
      amplitude_error =
          std::max(amplitude_error, std::abs(measured.returns[0].amplitude[pixel] * r2 / rho(p_m) - 1.0));
      distance_error_m =
          std::max(distance_error_m, std::abs(measured.returns[0].distance_m[pixel] - std::sqrt(r2)));
    }
  check_within(engine, name + ", amplitude, relative", 0.0, amplitude_error, 1e-5);
  check_within(engine, name + ", distance", 0.0, distance_error_m, 2e-6);
}

Surface red_stairs() {
  Paint paint;
  paint.reflectivity_rgb = {1.0, 0.0, 0.0};
  paint.texture = std::make_shared<const Texture>(stairs());
  return {0.0, false, paint};
}

} // namespace

TEST_CASE("a texture is the reflectivity") {
  const Engine engine = both_engines();
  Surface surface = red_stairs();
  const auto filter = GENERATE(TextureFilter::nearest, TextureFilter::linear);
  const auto [wrap_u, wrap_v, wraps] =
      GENERATE(table<Wrap, Wrap, std::string>({{Wrap::repeat, Wrap::mirrored_repeat, "repeat, mirrored"},
                                               {Wrap::mirrored_repeat, Wrap::clamp, "mirrored, clamp"},
                                               {Wrap::clamp, Wrap::repeat, "clamp, repeat"}}));
  surface.paint->filter = filter;
  surface.paint->wrap_u = wrap_u;
  surface.paint->wrap_v = wrap_v;
  Scene scene = wall_with(surface);
  give_texture_coordinates(scene);
  const std::string name =
      fmt::format("texture {}, {}", filter == TextureFilter::nearest ? "nearest" : "linear", wraps);
  const auto rho = [&](const glm::dvec2 &p_m) { return stairs_at(uv_of(p_m), *surface.paint); };
  check_wall(engine, name, scene, rho);
  if (engine == Engine::vulkan)
    check_wall(engine, name + ", pairs", scene, rho,
               {.device = {}, .precision = SamplePrecision::double_float});
}

TEST_CASE("colours are weighed, and texel and vertex colour multiply") {
  const Engine engine = both_engines();
  Surface surface = red_stairs();
  surface.reflectivity = 0.01;
  surface.paint->reflectivity_rgb = {0.2, 0.3, 0.4};
  Scene scene = wall_with(surface);
  give_texture_coordinates(scene);
  // Red falls from 1 to 0.2 from left to right, green from 1 to 0.5 from top to bottom.
  scene.colours = {{1, 1, 1, 1}, {1, 0.5, 1, 1}, {0.2f, 0.5, 1, 1}, {0.2f, 1, 1, 1}};
  check_wall(engine, "texel times vertex colour", scene, [&](const glm::dvec2 &p_m) {
    const glm::dvec2 across = (p_m + 0.6) / 1.2;
    const double red = stairs_at(uv_of(p_m), *surface.paint) * (1 - across.x * (1 - double{0.2f}));
    return 0.01 + 0.2 * red + 0.3 * double{0.9f} * (1 - 0.5 * across.y) + 0.4 * double{0.3f};
  });
}

TEST_CASE("through the holes of a mask the wall behind is seen") {
  const Engine engine = both_engines();
  Surface surface = red_stairs();
  surface.paint->filter = TextureFilter::nearest;
  surface.paint->alpha = 0.5;
  surface.paint->alpha_cutoff = 0.5 * 0.06 * 7.5; // texels 0 to 6 are holes
  Scene scene = wall_with(surface);
  give_texture_coordinates(scene);
  SceneBuilder behind;
  behind.add_wall({3.0});
  scene.positions_m.insert(scene.positions_m.end(), behind.scene().positions_m.begin(),
                           behind.scene().positions_m.end());
  scene.texture_coordinates.resize(8);
  scene.surfaces.emplace_back();
  scene.objects.emplace_back("behind");
  scene.triangles.push_back({{4, 5, 6}, 1, 1});
  scene.triangles.push_back({{4, 6, 7}, 1, 1});

  const Sensor sensor = wall_sensor();
  const Measurement measured = measure_monostatic(engine, scene, sensor);
  std::size_t holes = 0, wrong = 0;
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const glm::dvec2 p_m = on_wall_m(sensor, column, row);
      const bool hole = stairs_at(uv_of(p_m), *surface.paint) < 0.05 * 7.5;
      const double distance_m = (hole ? 1.5 : 1.0) * std::sqrt(glm::dot(p_m, p_m) + wall_m * wall_m);
      const std::size_t pixel = std::size_t{row} * sensor.resolution.x + column;
      holes += hole;
      wrong += std::abs(measured.returns[0].distance_m[pixel] - distance_m) > 2e-6 ||
               measured.object_id[pixel] != (hole ? 1u : 0u);
    }
  CHECK(holes > 500);
  check_within(engine, "pixels that see the wrong wall", 0, static_cast<double>(wrong), 0);
}
