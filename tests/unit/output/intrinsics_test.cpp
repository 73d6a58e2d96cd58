#include "host/output/intrinsics.h"
#include "host/output/manifest.h"

#include <catch2/catch.hpp>
#include <limits>

using namespace pmdsim;

namespace {

// 4 x 2 pixels, not square, focused at 1 m: S2 = 1/(1/0.1 - 1/1) = 1/9 m.
Sensor small_sensor() {
  Sensor sensor;
  sensor.resolution = {4, 2};
  sensor.pixel_pitch_m = {1e-3, 2e-3};
  sensor.focal_length_m = 0.1;
  sensor.focus_distance_m = 1.0;
  return sensor;
}

} // namespace

TEST_CASE("a point on a pixel's ray projects onto that pixel") {
  const Sensor sensor = small_sensor();
  const auto [fx, fy, cx, cy] = intrinsics_of(sensor);
  for (std::uint32_t column = 0; column < 4; ++column)
    for (std::uint32_t row = 0; row < 2; ++row) {
      // The pixel's centre on the chip, by the design's formula, seen at a depth of 3 m.
      const double x_m = (column + 0.5 - 4 / 2.0) * 1e-3 / (1.0 / 9.0) * 3.0;
      const double y_m = (row + 0.5 - 2 / 2.0) * 2e-3 / (1.0 / 9.0) * 3.0;
      CHECK(fx * x_m / 3.0 + cx == Approx(column).margin(1e-12));
      CHECK(fy * y_m / 3.0 + cy == Approx(row).margin(1e-12));
    }
}

TEST_CASE("the manifest's camera takes distances to points of the world") {
  Sensor sensor = small_sensor();
  // Camera x is the world's z, camera y its x, camera z its y.
  sensor.world_from_camera = {glm::dmat3(0, 0, 1, 1, 0, 0, 0, 1, 0), {10, 20, 30}};
  const auto camera = camera_json(sensor);
  const auto matrix = [&](std::size_t row, std::size_t column) {
    return camera["camera_matrix"][row][column].get<double>();
  };
  const glm::dvec3 ray = glm::normalize(
      glm::dvec3((3 - matrix(0, 2)) / matrix(0, 0), (1 - matrix(1, 2)) / matrix(1, 1), 1.0)); // pixel (3, 1)
  const glm::dvec4 point_camera(2.0 * ray, 1.0);
  glm::dvec4 point_world(0.0);
  for (std::uint32_t row = 0; row < 4; ++row)
    for (std::uint32_t column = 0; column < 4; ++column)
      point_world[static_cast<int>(row)] +=
          camera["world_from_camera"][row][column].get<double>() * point_camera[static_cast<int>(column)];
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1.5e-3, 1e-3, 1.0 / 9.0));
  CHECK(point_world.x == Approx(10 + 2.0 * direction.y));
  CHECK(point_world.y == Approx(20 + 2.0 * direction.z));
  CHECK(point_world.z == Approx(30 + 2.0 * direction.x));
  CHECK(point_world.w == 1.0);
}

TEST_CASE("a manifest lists frames and outputs, and knows no error of the exact mode") {
  const RunRecord run{"render",
                      "some device",
                      "some driver",
                      "exact",
                      {{"scene", "wall.gltf"}},
                      {{small_sensor(), 7, 1.5, {{"accumulate", 1.25}}, {"pmd_0007.exr"}}}};
  const auto manifest = nlohmann::json::parse(json_text(manifest_json(run)));
  CHECK(manifest["setup"]["scene"] == "wall.gltf");
  CHECK(manifest["device"] == "some device");
  const auto &frame = manifest["frames"].at(0);
  CHECK(frame["sensor"] == "pmd");
  CHECK(frame["frame"] == 7);
  CHECK(frame["passes_ms"]["accumulate"] == 1.25);
  CHECK(frame["error_claimed_m"].is_null());
  CHECK(frame["outputs"] == nlohmann::json{"pmd_0007.exr"});
  CHECK(frame["camera"]["distortion"] == nlohmann::json{0.0, 0.0, 0.0, 0.0, 0.0});
}

TEST_CASE("NaN is null in JSON") {
  CHECK(json_text({{"mean", std::numeric_limits<double>::quiet_NaN()}}) == "{\n  \"mean\": null\n}\n");
}
