#include "tests/support/shadow_setups.h"

#include "tests/support/painted_scenes.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <cmath>
#include <numbers>

namespace pmdsim::test {

namespace {

// A step of a length between these, in any direction.
glm::dvec3 random_step_m(Random &random, double shortest_m, double longest_m) {
  const double length_m = random.log_uniform(shortest_m, longest_m);
  return length_m * random.unit_vector();
}

glm::dvec3 place_in_view(Random &random) {
  const double z_m = random.uniform(0.5, 3.0);
  return {z_m * random.uniform(-0.7, 0.7), z_m * random.uniform(-0.7, 0.7), z_m};
}

Surface one_or_two_sided(Random &random) { return {random.uniform(0.1, 1.0), random.flip()}; }

void add_loose(Random &random, SceneBuilder &builder) {
  const glm::dvec3 centre_m = place_in_view(random);
  const double size_m = random.log_uniform(0.003, 1.0);
  const glm::dvec3 a = centre_m + size_m * random.unit_vector(), b = centre_m + size_m * random.unit_vector(),
                   c = centre_m + size_m * random.unit_vector();
  builder.add_triangle(a, b, c, one_or_two_sided(random));
}

void add_sliver(Random &random, SceneBuilder &builder) {
  const glm::dvec3 from_m = place_in_view(random);
  const glm::dvec3 to_m = from_m + random_step_m(random, 0.05, 1.5);
  const glm::dvec3 beside_m = from_m + random_step_m(random, 2e-5, 5e-3);
  builder.add_triangle(from_m, to_m, beside_m, one_or_two_sided(random));
}

// Fills most of the view, across it or slanting.
void add_background(Random &random, SceneBuilder &builder) {
  const double slant = random.flip() ? 0.0 : random.uniform(-0.4, 0.4);
  const glm::dvec3 centre_m(0, 0, 3.2), u_m(4, 0, 4 * slant), v_m(0, 4, -2 * slant);
  builder.add_mesh({centre_m - u_m - v_m, centre_m - u_m + v_m, centre_m + u_m + v_m, centre_m + u_m - v_m},
                   {{0, 1, 2}, {0, 2, 3}}, one_or_two_sided(random));
}

// Columns and rows of squares of two triangles each, in one plane or bumpy.
void add_grid(Random &random, SceneBuilder &builder, std::uint32_t columns, std::uint32_t rows) {
  const glm::dvec3 corner_m = place_in_view(random);
  const double size_m = random.log_uniform(0.1, 1.5);
  const glm::dvec3 u_m = size_m * random.unit_vector(), v_m = size_m * random.unit_vector();
  const double highest_bump_m = random.flip() ? 0.0 : 0.05 * size_m;
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  for (std::uint32_t i = 0; i <= rows; ++i)
    for (std::uint32_t j = 0; j <= columns; ++j) {
      const glm::dvec3 flat_m = corner_m + u_m * (static_cast<double>(j) / columns - 0.5) +
                                v_m * (static_cast<double>(i) / rows - 0.5);
      const double bump_m = random.uniform(0, highest_bump_m);
      corners_m.push_back(flat_m + bump_m * random.unit_vector());
      const std::uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
      if (i < rows && j < columns)
        faces.insert(faces.end(), {{a, b, b + 1}, {a, b + 1, a + 1}});
    }
  builder.add_mesh(corners_m, faces, one_or_two_sided(random));
}

// Each a little behind the one before.
void add_stack(Random &random, SceneBuilder &builder, std::size_t count) {
  const glm::dvec3 a = place_in_view(random);
  const double size_m = random.log_uniform(0.05, 1.0);
  const glm::dvec3 b = a + size_m * random.unit_vector(), c = a + size_m * random.unit_vector();
  const glm::dvec3 gap_m = random_step_m(random, 5e-5, 2e-2);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 shift_m = static_cast<double>(i) * gap_m;
    builder.add_triangle(a + shift_m, b + shift_m, c + shift_m, one_or_two_sided(random));
  }
}

Scene random_scene(Random &random, std::size_t triangles, const Pose &world_from_camera) {
  SceneBuilder builder(world_from_camera);
  if (triangles > 2 && random.uniform(0, 1) < 0.8)
    add_background(random, builder);
  while (builder.scene().triangles.size() < triangles) {
    const std::size_t left = triangles - builder.scene().triangles.size();
    const double kind = random.uniform(0, 1);
    const auto rows = static_cast<std::uint32_t>(random.uniform(1, 9));
    if (kind < 0.04 && left >= 2 * rows * rows)
      add_grid(random, builder, rows, rows);
    else if (kind < 0.06 && left >= rows)
      add_stack(random, builder, rows);
    else if (kind < 0.3)
      add_sliver(random, builder);
    else
      add_loose(random, builder);
  }
  return builder.scene();
}

using Layout = std::vector<glm::dvec3>;

Layout ring(Random &random, std::size_t count) {
  const double radius_m = random.log_uniform(0.01, 0.4);
  Layout places_m;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count);
    places_m.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0);
  }
  return places_m;
}

Layout cloud(Random &random, std::size_t count, const glm::dvec3 &centre_m) {
  const double half_m = random.log_uniform(1e-3, 0.5);
  Layout places_m;
  for (std::size_t k = 0; k < count; ++k)
    places_m.push_back(centre_m + random.in_box(glm::dvec3(-half_m), glm::dvec3(half_m)));
  return places_m;
}

Layout line(Random &random, std::size_t count) {
  const glm::dvec3 from_m = random.in_box(glm::dvec3(-0.5), glm::dvec3(0.5));
  const glm::dvec3 step_m = random_step_m(random, 1e-3, 0.02);
  Layout places_m;
  for (std::size_t k = 0; k < count; ++k)
    places_m.push_back(from_m + static_cast<double>(k) * step_m);
  return places_m;
}

Layout random_layout(Random &random, std::size_t count) {
  const double kind = random.uniform(0, 1);
  if (kind < 0.4)
    return ring(random, count);
  if (kind < 0.55)
    return line(random, count);
  if (kind < 0.7)
    return cloud(random, count, glm::dvec3(0));
  if (kind < 0.85)
    return cloud(random, count, place_in_view(random));
  return cloud(random, count, 10.0 * random.unit_vector());
}

std::vector<Illuminator> random_illuminators(Random &random, std::size_t diodes, const Sensor &sensor) {
  std::vector<Illuminator> illuminators;
  const auto most = static_cast<std::size_t>(random.uniform(1, 4));
  for (std::size_t left = diodes; left > 0;) {
    const bool last = illuminators.size() + 1 == most;
    const auto count = last ? left : 1 + static_cast<std::size_t>(random.uniform(0, double(left)));
    illuminators.push_back({"light", sensor.world_from_camera, {}});
    for (const glm::dvec3 &place_m : random_layout(random, count))
      illuminators.back().diodes.push_back(diode_at(place_m));
    left -= count;
  }
  return illuminators;
}

} // namespace

ShadowSetup random_shadow_setup(std::uint32_t seed) {
  Random random(seed);
  ShadowSetup setup;
  setup.sensor.resolution = {24, 24};
  setup.sensor.pixel_pitch_m = {6e-3, 6e-3};
  setup.sensor.focal_length_m = 0.1; // 72 degrees
  setup.sensor.world_from_camera = random.pose(10.0);
  const auto triangles = static_cast<std::size_t>(random.log_uniform(1, 2001));
  setup.scene = random_scene(random, triangles, setup.sensor.world_from_camera);
  if (seed % 3 == 1)
    paint(random, setup.scene);
  if (seed % 4 == 2)
    scatter_discs(random, 1 + seed % 50, setup.sensor.world_from_camera, setup.scene);
  const auto diodes = static_cast<std::size_t>(random.log_uniform(1, 301));
  setup.illuminators = random_illuminators(random, diodes, setup.sensor);
  return setup;
}

} // namespace pmdsim::test
