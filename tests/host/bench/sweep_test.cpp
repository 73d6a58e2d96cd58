// The benchmark's sweep: its setups are what they say, its points are checked, its lines fit.

#include "engine/model/error.h"
#include "host/bench/sweep.h"
#include "host/capture/camera.h"
#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;

namespace {

void check_same_sensor(const Sensor &a, const Sensor &b) {
  CHECK(a.resolution == b.resolution);
  CHECK(a.pixel_pitch_m.x == Approx(b.pixel_pitch_m.x));
  CHECK(a.focal_length_m == b.focal_length_m);
  CHECK(a.modulation_hz == b.modulation_hz);
  CHECK(a.samples == b.samples);
}

double largest_coordinate_difference_m(const glm::dvec3 &a, const glm::dvec3 &b) {
  return glm::length(a - b);
}

bool is_on_wall(const glm::dvec3 &place_m) {
  return std::abs(place_m.x) <= 0.2 && std::abs(place_m.y) <= 0.2 && place_m.z == -2.0;
}

// Twice the area of the triangle, seen from the lens: positive where its front shows.
double double_area_m2(const Scene &scene, const Triangle &triangle) {
  const glm::dvec3 a = scene.positions_m[triangle.vertices[0]];
  const glm::dvec3 b = scene.positions_m[triangle.vertices[1]], c = scene.positions_m[triangle.vertices[2]];
  return glm::cross(b - a, c - a).z;
}

} // namespace

TEST_CASE("the sweep's ring is scenes/paper_ring.json") {
  const Setup mine = paper_ring(), file = load_setup(test::scene("paper_ring.json"));
  CHECK(mine.backscatter == file.backscatter);
  CHECK(mine.shadows == file.shadows);
  check_same_sensor(mine.start.sensors.front(), file.start.sensors.front());
  const auto &diodes = mine.start.illuminators.front().diodes;
  const auto &expected = file.start.illuminators.front().diodes;
  REQUIRE(diodes.size() == expected.size());
  for (std::size_t i = 0; i < diodes.size(); ++i) {
    CHECK(largest_coordinate_difference_m(diodes[i].position_m, expected[i].position_m) < 1e-12);
    CHECK(diodes[i].intensity_w_sr == expected[i].intensity_w_sr);
    CHECK(diodes[i].pattern.kind == Pattern::Kind::isotropic);
  }
  CHECK(mine.start.scene.triangles.size() == file.start.scene.triangles.size());
  CHECK(mine.start.scene.surfaces.front().reflectivity ==
        Approx(file.start.scene.surfaces.front().reflectivity));
  for (const glm::dvec3 &vertex_m : file.start.scene.positions_m)
    CHECK(is_on_wall(glm::dvec3(glm::vec3(vertex_m)) * (1.0 - 1e-7)) ==
          is_on_wall(mine.start.scene.positions_m.front() * (1.0 - 1e-7)));
}

TEST_CASE("a sweep changes its own quantity and nothing else") {
  for (const std::vector<SweepPoint> &points : all_sweeps())
    for (const SweepPoint &point : points) {
      INFO(point.name());
      const Setup setup = swept_setup(point);
      const Sensor &sensor = setup.start.sensors.front();
      const auto is = [&](SweptQuantity other, std::uint32_t usual) {
        return point.quantity == other ? point.value : usual;
      };
      CHECK(sensor.resolution == glm::uvec2(is(SweptQuantity::resolution, 640)));
      CHECK(sensor.pixel_pitch_m.x * sensor.resolution.x == Approx(640 * 45e-6)); // the same view
      CHECK(diode_count(setup.start.illuminators) == is(SweptQuantity::diodes, 240));
      CHECK(sensor.samples == is(SweptQuantity::samples, 1));
      CHECK(setup.start.scene.triangles.size() == is(SweptQuantity::triangles, 2));
      CHECK(sensor.modulation_hz.size() == is(SweptQuantity::frequencies, 1));
      CHECK(sensor.modulation_hz.front() == 20e6);
    }
}

TEST_CASE("a wall of many triangles is the wall, once over") {
  const Scene scene = swept_setup({SweptQuantity::triangles, 200}).start.scene;
  double sum_m2 = 0.0;
  for (const Triangle &triangle : scene.triangles) {
    CHECK(double_area_m2(scene, triangle) > 0.0);
    sum_m2 += double_area_m2(scene, triangle) / 2.0;
  }
  CHECK(sum_m2 == Approx(0.16));
  CHECK(std::ranges::all_of(scene.positions_m, [](const glm::dvec3 &place_m) {
    return is_on_wall(place_m * glm::dvec3(1.0 - 1e-12, 1.0 - 1e-12, 1.0));
  }));
}

TEST_CASE("sweeps go up, and their units are what time may grow with") {
  for (const std::vector<SweepPoint> &points : all_sweeps()) {
    CHECK(points.size() >= 4);
    CHECK(std::ranges::is_sorted(points, {}, &SweepPoint::value));
  }
  CHECK(SweepPoint{SweptQuantity::resolution, 160}.units() == 25600.0);
  CHECK(SweepPoint{SweptQuantity::samples, 4}.units() == 16.0);
  CHECK(SweepPoint{SweptQuantity::diodes, 60}.units() == 60.0);
  CHECK(SweepPoint{SweptQuantity::diodes, 60}.name() == "diodes 60");
}

TEST_CASE("a swept point has checked and timed frames") {
  const auto rows =
      run_sweep({{{SweptQuantity::resolution, 16}, {SweptQuantity::resolution, 32}}}, BenchRequest());
  REQUIRE(rows.size() == 2);
  for (const SweepRow &row : rows) {
    INFO(row.point.name());
    CHECK(row.checked_pixels == std::min(1024u, row.point.value * row.point.value));
    CHECK(row.error_m < 1e-6);
    CHECK(row.interactions == 240.0 * row.point.units());
    CHECK(row.frames.size() >= 5);
    CHECK(interactions_per_s(row.frames, row.interactions, Mode::exact) > 0.0);
    CHECK(std::isnan(interactions_per_s(row.frames, row.interactions, Mode::automatic)));
    CHECK(row.peak_memory_bytes.value() > 1'000'000);
  }
  const auto growths = growths_of(rows);
  REQUIRE(growths.size() == 1);
  CHECK(growths.front().points.size() == 2);
  CHECK(growths.front().points[1].size == 1024.0);
}

TEST_CASE("a frame that is off is not timed") {
  const Setup setup = swept_setup({SweptQuantity::resolution, 16});
  Camera camera("");
  camera.prepare(setup.start.scene, setup.start.sensors.front(), setup.start.illuminators, setup.backscatter,
                 setup.shadows);
  Measurement found = camera.measure();
  CHECK(check_at_random(setup, found, "device").error_m < 1e-6);
  const auto offset_m = GENERATE(0.001f, NAN);
  found.returns.front().distance_m[100] += offset_m;
  CHECK_THROWS_AS(check_at_random(setup, found, "device"), Error);
}

TEST_CASE("what is more costs the difference, and the first nothing that is known") {
  std::vector<SweepRow> rows;
  for (const auto &[diodes, ms] :
       std::vector<std::pair<std::uint32_t, double>>{{1, 5.5}, {10, 10.0}, {1000, 604.0}})
    rows.push_back(
        {.point = {SweptQuantity::diodes, diodes}, .peak_memory_bytes = {}, .frames = {{ms, {}, {}}}});
  const std::vector<double> marginal_ms = growths_of(rows).front().marginal_ms;
  REQUIRE(marginal_ms.size() == 3);
  CHECK(std::isnan(marginal_ms[0]));
  CHECK(marginal_ms[1] == Approx(0.5));
  CHECK(marginal_ms[2] == Approx(0.6));
}

TEST_CASE("a straight line fits points on one, and none goes below zero") {
  const std::vector<SizeAndTime> exact{{1.0, 5.5}, {10.0, 10.0}, {1000.0, 505.0}};
  const StraightLine line = straight_line(exact);
  CHECK(line.fixed_ms == Approx(5.0));
  CHECK(line.slope_ms == Approx(0.5));
  CHECK(line.at_ms(2000.0) == Approx(1005.0));
  const StraightLine steep = straight_line(std::vector<SizeAndTime>{{1.0, 1.0}, {2.0, 3.0}});
  CHECK(steep.fixed_ms == 0.0);
  CHECK(steep.slope_ms > 1.0);
  const StraightLine falling = straight_line(std::vector<SizeAndTime>{{1.0, 3.0}, {2.0, 2.0}});
  CHECK(falling.slope_ms == 0.0);
  CHECK(falling.fixed_ms > 2.0);
  CHECK(straight_line(std::vector<SizeAndTime>{{4.0, 8.0}}).slope_ms == Approx(2.0));
}
