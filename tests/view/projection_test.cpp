#include "engine/view/projection.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace pmdsim;

namespace {

Sensor small_sensor(glm::uvec2 resolution, std::uint32_t samples = 1) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.samples = samples;
  sensor.pixel_pitch_m = {1e-3, 1e-3};
  sensor.focal_length_m = 10e-3; // tan of half the view: resolution / 20
  return sensor;
}

CameraScene one_triangle(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
  return {{{{a, b, c}, 7}}, {{glm::dvec3(0, 0, -1), -1}}, {}};
}

double signed_area(const std::vector<shader::RasterVertex> &vertices) {
  double area = 0.0;
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    const auto &a = vertices[i], &b = vertices[i + 1], &c = vertices[i + 2];
    area +=
        0.5 *
        ((double(b.x_fragments) - double(a.x_fragments)) * (double(c.y_fragments) - double(a.y_fragments)) -
         (double(c.x_fragments) - double(a.x_fragments)) * (double(b.y_fragments) - double(a.y_fragments)));
  }
  return area;
}

} // namespace

TEST_CASE("a point on the optical axis lands in the middle of the frame, x right and y down") {
  const auto projection =
      project(one_triangle({0, 0, 2}, {0.2, 0, 2}, {0, 0.4, 2}), chip_blocks(small_sensor({20, 20}), 8192));
  REQUIRE(projection.vertices.size() == 3);
  CHECK(projection.vertices[0].x_fragments == 10.0f);
  CHECK(projection.vertices[0].y_fragments == 10.0f);
  CHECK(projection.vertices[1].x_fragments == 11.0f);
  CHECK(projection.vertices[2].y_fragments == 12.0f);
  CHECK(projection.vertices[0].triangle == 7);
  CHECK(projection.vertices[0].inverse_depth == 0.5f);
}

TEST_CASE("every vertex lies on the raster's grid and inside the margin") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-5.0, 5.0);
  for (int i = 0; i < 500; ++i) {
    const auto corner = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    const auto projection =
        project(one_triangle(corner(), corner(), corner()), chip_blocks(small_sensor({33, 17}, 3), 8192));
    for (const auto &vertex : projection.vertices) {
      CHECK(std::fmod(vertex.x_fragments * 256.0f, 1.0f) == 0.0f);
      CHECK(std::fmod(vertex.y_fragments * 256.0f, 1.0f) == 0.0f);
      CHECK(vertex.x_fragments >= -17.0f);
      CHECK(vertex.x_fragments <= 99.0f + 17.0f);
      CHECK(vertex.y_fragments >= -17.0f);
      CHECK(vertex.y_fragments <= 51.0f + 17.0f);
      CHECK(vertex.inverse_depth > 0.0f);
      CHECK(vertex.inverse_depth <= 0.5f);
    }
  }
}

TEST_CASE("what lies behind the lens is left out, what crosses its plane is cut") {
  CHECK(project(one_triangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1}), chip_blocks(small_sensor({20, 20}), 8192))
            .vertices.empty());
  // A floor half a metre below, from far behind to far in front: it fills the lower half of the frame.
  const auto floor = project(one_triangle({-100, 0.5, -10}, {100, 0.5, -10}, {0, 0.5, 1e9}),
                             chip_blocks(small_sensor({20, 20}), 8192));
  REQUIRE_FALSE(floor.vertices.empty());
  CHECK(std::abs(signed_area(floor.vertices)) >= 20.0 * 10.0 - 1.0);
}

TEST_CASE("blocks and their clipping change no area") {
  const auto triangle = one_triangle({-3, -3, 2}, {3, -2, 3}, {0, 4, 5});
  const Sensor sensor = small_sensor({40, 30});
  const auto whole = project(triangle, chip_blocks(sensor, 8192));
  REQUIRE(whole.blocks.size() == 1);
  const auto cut = project(triangle, chip_blocks(sensor, 16));
  REQUIRE(cut.blocks.size() == 6);
  std::uint64_t pixels = 0;
  for (const RasterBlock &block : cut.blocks) {
    CHECK(block.pixels.x <= 16);
    CHECK(block.pixels.y <= 16);
    pixels += std::uint64_t{block.pixels.x} * block.pixels.y;
  }
  CHECK(pixels == sensor.pixel_count());
}

TEST_CASE("neighbours that are clipped stay watertight") {
  // Two triangles share the edge from (-3, -2.7, 1) to (4, 3.3, 6), which leaves the frame on both sides.
  const glm::dvec3 a(-3, -2.7, 1), b(4, 3.3, 6), left(-3, 3, 4), right(3, -3, 2);
  const Sensor sensor = small_sensor({20, 20});
  const auto one = project(one_triangle(a, b, left), chip_blocks(sensor, 8192)).vertices;
  const auto other = project(one_triangle(b, a, right), chip_blocks(sensor, 8192)).vertices;
  int shared = 0;
  for (const auto &p : one)
    for (const auto &q : other)
      shared += p.x_fragments == q.x_fragments && p.y_fragments == q.y_fragments && p.inverse_depth > 0.0f;
  CHECK(shared >= 2);
}

TEST_CASE("the visible boxes hold every clipped corner and nothing outside the view") {
  const auto projection = project(one_triangle({-100, 0.5, -10}, {100, 0.5, -10}, {0, 0.5, 50}),
                                  chip_blocks(small_sensor({20, 20}), 8192));
  REQUIRE(projection.visible.size() == 1);
  CHECK(projection.visible[0].low_m.y == Approx(0.5));
  CHECK(projection.visible[0].high_m.y == Approx(0.5));
  CHECK(projection.visible[0].low_m.z >
        0.15); // where the view's lower edge, widened by the margin, meets the floor
  CHECK(projection.visible[0].high_m.z <= 50.0);
}
