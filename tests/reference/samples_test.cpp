// Where samples lie, how they count, and which of them gives a pixel its ids.

#include "engine/reference/reference.h"
#include "tests/reference/monostatic_frame.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// One pixel that spans x/z and y/z from -1/2 to 1/2.
Sensor one_wide_pixel(std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {1, 1};
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = glm::dvec2(0.1);
  sensor.samples = samples;
  return sensor;
}

// One small triangle around each of the points where the rays of an S x S grid of samples cross z = 1, in row
// order.
Scene target_per_sample(std::uint32_t samples, const glm::dvec2 &fill_factor = glm::dvec2(1)) {
  SceneBuilder builder;
  for (std::uint32_t row = 0; row < samples; ++row)
    for (std::uint32_t column = 0; column < samples; ++column) {
      const glm::dvec3 centre(fill_factor.x * ((column + 0.5) / samples - 0.5),
                              fill_factor.y * ((row + 0.5) / samples - 0.5), 1.0);
      const glm::dvec2 size = 0.2 / samples * fill_factor;
      builder.add_triangle(centre + glm::dvec3(-size.x, -size.y, 0), centre + glm::dvec3(-size.x, size.y, 0),
                           centre + glm::dvec3(2 * size.x, 0, 0));
    }
  return builder.scene();
}

} // namespace

TEST_CASE("samples lie at ((k + 1/2) / S - 1/2) pixels from the centre, columns to the right, rows down") {
  const std::uint32_t samples = GENERATE(1u, 2u, 3u, 5u);
  const auto frame = monostatic_frame(target_per_sample(samples), one_wide_pixel(samples));
  REQUIRE(frame.sample_triangle_id.size() == samples * samples);
  for (std::uint32_t k = 0; k < samples * samples; ++k)
    CHECK(frame.sample_triangle_id[k] == k);
  CHECK(frame.coverage[0] == 1);
}

TEST_CASE("a fill factor draws the samples together about the pixel's centre") {
  const std::uint32_t samples = GENERATE(1u, 2u, 5u);
  const glm::dvec2 fill_factor = GENERATE(glm::dvec2(0.5, 0.5), glm::dvec2(0.9, 0.3));
  Sensor sensor = one_wide_pixel(samples);
  sensor.fill_factor = fill_factor;
  const auto frame = monostatic_frame(target_per_sample(samples, fill_factor), sensor);
  for (std::uint32_t k = 0; k < samples * samples; ++k)
    CHECK(frame.sample_triangle_id[k] == k);
}

TEST_CASE("a pixel's dead area sees nothing and takes nothing from the mean") {
  Sensor sensor = one_wide_pixel(4);
  sensor.pixel_pitch_m = glm::dvec2(1e-6);
  sensor.fill_factor = {0.5, 1};
  SceneBuilder active_half, dead_half;
  active_half.add_wall({1, {}, {-0.25e-5, -1}, {0.25e-5, 1}});
  dead_half.add_wall({1, {}, {-1, -1}, {-0.25e-5, 1}});
  dead_half.add_wall({1, {}, {0.25e-5, -1}, {1, 1}});
  CHECK(monostatic_frame(active_half.scene(), sensor).returns[0].amplitude[0] == Approx(1).epsilon(1e-9));
  CHECK(monostatic_frame(dead_half.scene(), sensor).returns[0].amplitude[0] == 0);
}

TEST_CASE("ids are those of the sample nearest the centre, up and left where several are") {
  const auto [samples, nearest] =
      GENERATE(table<std::uint32_t, std::uint32_t>({{1, 0}, {2, 0}, {3, 4}, {4, 5}, {5, 12}}));
  const auto frame = monostatic_frame(target_per_sample(samples), one_wide_pixel(samples));
  CHECK(frame.triangle_id[0] == nearest);
  CHECK(frame.object_id[0] == nearest);
}

TEST_CASE("pixels and their samples are row-major from the top left") {
  Sensor sensor = one_wide_pixel(1);
  sensor.resolution = {3, 2};
  sensor.pixel_pitch_m = {0.1 / 3, 0.1 / 2};
  sensor.samples = 2;
  SceneBuilder builder;
  builder.add_wall({1, {}, {1.0 / 6, 0}, {0.5, 0.5}}); // bottom right pixel
  const auto frame = monostatic_frame(builder.scene(), sensor);
  CHECK(frame.coverage == std::vector<double>{0, 0, 0, 0, 0, 1});
  const std::vector<bool> expected{0, 0, 0, 0, 0, 0, /**/ 0, 0, 0, 0, 0, 0,
                                   0, 0, 0, 0, 1, 1, /**/ 0, 0, 0, 0, 1, 1};
  for (std::size_t sample = 0; sample < expected.size(); ++sample)
    CHECK((frame.sample_triangle_id[sample] != no_id) == expected[sample]);
}

TEST_CASE("samples that miss count in the mean of the light and not in that of the range") {
  SceneBuilder left_half;
  left_half.add_wall({2, {}, {-9, -9}, {0, 9}});
  Sensor sensor = one_wide_pixel(4);
  sensor.pixel_pitch_m = glm::dvec2(1e-7);
  const auto half = monostatic_frame(left_half.scene(), sensor);
  const auto whole = monostatic_frame(wall_at(2), sensor);
  CHECK(half.coverage[0] == 0.5);
  CHECK(half.returns[0].amplitude[0] == Approx(whole.returns[0].amplitude[0] / 2).epsilon(1e-12));
  CHECK(half.range_m[0] == Approx(2).epsilon(1e-11));
  CHECK(half.z_m[0] == Approx(2).epsilon(1e-14));
  CHECK(half.returns[0].distance_m[0] == Approx(whole.returns[0].distance_m[0]).epsilon(1e-12));
}

TEST_CASE("a pixel whose centre sees nothing has no id, whatever else it sees") {
  SceneBuilder builder;
  builder.add_wall({2, {}, {-0.9, -0.9}, {-0.5, 0.9}});
  const auto frame = monostatic_frame(builder.scene(), one_wide_pixel(3));
  CHECK(frame.coverage[0] == Approx(1.0 / 3));
  CHECK(frame.triangle_id[0] == no_id);
  CHECK(frame.object_id[0] == no_id);
}

TEST_CASE("chosen pixels measure what they measure in the whole frame") {
  Sensor sensor = one_wide_pixel(3);
  sensor.resolution = {5, 4};
  sensor.pixel_pitch_m /= 5.0;
  SceneBuilder builder;
  builder.add_wall({1.2, {}, {-0.3, -0.3}, {0.25, 0.1}});
  builder.add_wall({2.0, {}, {-0.9, -0.9}, {0.7, 0.7}});
  const auto measured = [&](const std::vector<std::uint32_t> &pixels) {
    return reference::simulate(
        builder.scene(), sensor,
        {diode_beside_lens(sensor, diode_at({0.1, 0, 0})), monostatic_illuminator(sensor.world_from_camera)},
        Backscatter::lambert, {.shadows = Shadows::automatic, .keep_visibility = true, .pixels = pixels});
  };
  const std::vector<std::uint32_t> pixels{17, 3, 4, 11, 12};
  const auto whole = measured({}), chosen = measured(pixels);
  CHECK(chosen.resolution == glm::uvec2(1, 5));
  REQUIRE(chosen.sample_triangle_id.size() == 5 * 9);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    INFO("pixel " << pixels[i]);
    CHECK(chosen.returns[0].z[i] == whole.returns[0].z[pixels[i]]);
    CHECK(chosen.returns[0].taps[1][i] == whole.returns[0].taps[1][pixels[i]]);
    CHECK(chosen.coverage[i] == whole.coverage[pixels[i]]);
    CHECK(chosen.lit[i] == whole.lit[pixels[i]]);
    CHECK(chosen.triangle_id[i] == whole.triangle_id[pixels[i]]);
    for (std::size_t k = 0; k < 9; ++k) {
      const std::size_t row = pixels[i] / 5 * 3 + k / 3, column = pixels[i] % 5 * 3 + k % 3;
      CHECK(chosen.sample_triangle_id[9 * i + k] == whole.sample_triangle_id[15 * row + column]);
      CHECK(chosen.sample_visibility[9 * i + k] == whole.sample_visibility[15 * row + column]);
    }
  }
}

TEST_CASE("an empty scene is dark and without distance") {
  const auto frame = monostatic_frame({}, axial_sensor({3, 2}));
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    CHECK(frame.returns[0].z[pixel] == 0.0);
    CHECK(frame.returns[0].amplitude[pixel] == 0);
    CHECK(frame.coverage[pixel] == 0);
    CHECK(std::isnan(frame.returns[0].phase_rad[pixel]));
    CHECK(std::isnan(frame.returns[0].distance_m[pixel]));
    CHECK(std::isnan(frame.range_m[pixel]));
    CHECK(std::isnan(frame.z_m[pixel]));
    CHECK(frame.triangle_id[pixel] == no_id);
    CHECK(frame.object_id[pixel] == no_id);
  }
}

TEST_CASE("progress is reported and can stop a frame") {
  const Sensor sensor = axial_sensor({2, 400});
  const Illuminator light = monostatic_illuminator(sensor.world_from_camera);
  double last = -1;
  reference::simulate(wall_at(2), sensor, {light}, Backscatter::constant, {}, [&](double fraction) {
    CHECK(fraction > last);
    last = fraction;
  });
  CHECK(last == 1);
  const auto stop = [](double) { throw std::runtime_error("stop"); };
  CHECK_THROWS_WITH(reference::simulate(wall_at(2), sensor, {light}, Backscatter::constant, {}, stop),
                    "stop");
}
