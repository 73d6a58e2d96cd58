#include "tests/support/painted_scenes.h"

#include <array>

namespace pmdsim::test {

namespace {

constexpr std::array wraps{Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp};

glm::vec4 random_colour(Random &random) {
  glm::vec4 colour;
  for (glm::length_t k = 0; k < 4; ++k)
    colour[k] = static_cast<float>(random.uniform(0.05, 1.0));
  return colour;
}

Wrap random_wrap(Random &random) { return wraps.at(static_cast<std::size_t>(random.uniform(0, 3))); }

Paint random_paint(Random &random) {
  Paint paint;
  paint.reflectivity_rgb = random.in_box(glm::dvec3(0.05), glm::dvec3(0.33));
  if (random.uniform(0, 1) < 0.8) {
    const auto columns = static_cast<std::uint32_t>(random.uniform(1, 9));
    const auto rows = static_cast<std::uint32_t>(random.uniform(1, 9));
    paint.texture = random_texture(random, {columns, rows});
  }
  paint.wrap_u = random_wrap(random);
  paint.wrap_v = random_wrap(random);
  paint.filter = random.flip() ? TextureFilter::linear : TextureFilter::nearest;
  if (random.flip()) {
    paint.alpha = random.uniform(0.5, 1.0);
    paint.alpha_cutoff = random.uniform(0.05, 0.3);
  }
  return paint;
}

} // namespace

std::shared_ptr<const Texture> random_texture(Random &random, const glm::uvec2 &size) {
  Texture texture{size, {}};
  for (std::uint32_t i = 0; i < size.x * size.y; ++i)
    texture.texels.push_back(random_colour(random));
  return std::make_shared<const Texture>(std::move(texture));
}

void paint(Random &random, Scene &scene) {
  for (Surface &surface : scene.surfaces)
    if (random.uniform(0, 1) < 0.8) {
      surface.paint = random_paint(random);
      surface.reflectivity = random.flip() ? 0.0 : 0.1;
    }
  for (std::size_t i = 0; i < scene.positions_m.size(); ++i) {
    const double u = random.uniform(-1.5, 2.5), v = random.uniform(-1.5, 2.5);
    scene.texture_coordinates.emplace_back(u, v);
    scene.colours.push_back(random_colour(random));
  }
}

void scatter_discs(Random &random, std::size_t count, const Pose &world_from_camera, Scene &scene) {
  const auto surface = static_cast<std::uint32_t>(scene.surfaces.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.surfaces.push_back({0.5, false});
  if (!scene.colours.empty())
    scene.surfaces.back() = {0.0, false, Paint{glm::dvec3(0.2, 0.5, 0.1)}};
  scene.objects.emplace_back("points");
  for (std::size_t i = 0; i < count; ++i) {
    scene.discs.push_back(
        {static_cast<std::uint32_t>(scene.positions_m.size()), random.uniform(0.002, 0.06), surface, object});
    scene.positions_m.push_back(world_from_camera.point(random.in_box({-0.7, -0.7, 0.8}, {0.7, 0.7, 2.5})));
    if (!scene.colours.empty()) {
      scene.colours.push_back(random_colour(random));
      scene.texture_coordinates.emplace_back(0.0);
    }
  }
}

} // namespace pmdsim::test
