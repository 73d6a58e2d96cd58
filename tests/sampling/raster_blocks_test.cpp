// Where samples fall on the rasters that the frame is cut into.

#include "engine/sampling/raster_blocks.h"

#include "engine/lens/lens.h"
#include "engine/model/error.h"
#include "tests/support/random_cameras.h"
#include "tests/support/units.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr std::uint32_t largest_block = 8192;

glm::dvec2 on_raster(const RasterBlock &block, const glm::dvec3 &ray) {
  const glm::dvec3 h = block.raster_from_camera * ray;
  if (!(h.z > 0.0))
    FAIL("a ray behind its raster");
  return glm::dvec2(h) / h.z;
}

// In the frame, in pixels: of sample `k` of `S` in a pixel (docs/theory.md, "Conventions").
glm::dvec2 place_of(const Sensor &sensor, const glm::uvec2 &pixel, const glm::uvec2 &subsample) {
  return glm::dvec2(pixel) + 0.5 +
         ((glm::dvec2(subsample) + 0.5) / double(sensor.samples) - 0.5) * sensor.fill_factor;
}

std::vector<int> covered_pixels(const Sensor &sensor, const std::vector<RasterBlock> &blocks) {
  std::vector<int> covered(sensor.pixel_count());
  for (const RasterBlock &block : blocks)
    for (std::uint32_t row = 0; row < block.pixels.y; ++row)
      for (std::uint32_t column = 0; column < block.pixels.x; ++column) {
        const glm::uvec2 pixel = block.first_pixel + glm::uvec2(column, row);
        ++covered.at(std::size_t{pixel.y} * sensor.resolution.x + pixel.x);
      }
  return covered;
}

void check_every_pixel_once(const Sensor &sensor, const std::vector<RasterBlock> &blocks) {
  CHECK(covered_pixels(sensor, blocks) == std::vector<int>(sensor.pixel_count(), 1));
}

// The largest distance of a sample from where it should be on its fragment, over some of the samples.
double largest_error_fragments(const Sensor &sensor, const RasterBlock &block) {
  const Lens lens(sensor);
  const std::uint32_t side = is_tiled(sensor) ? 1 : sensor.samples;
  double largest = 0.0;
  for (glm::uvec2 pixel(0); pixel.y < block.pixels.y; pixel.y += 3)
    for (pixel.x = 0; pixel.x < block.pixels.x; pixel.x += 3)
      for (glm::uvec2 k(0); k.y < sensor.samples; ++k.y)
        for (k.x = 0; k.x < sensor.samples; ++k.x) {
          const auto ray = lens.ray(lens.on_chip_m(place_of(sensor, block.first_pixel + pixel, k)));
          const glm::dvec2 centre = glm::dvec2(pixel * side + k % side) + 0.5;
          const glm::dvec2 expected = centre + glm::dvec2(raster_shift(sensor, k));
          const glm::dvec2 error = glm::abs(on_raster(block, *ray) - expected);
          largest = std::max({largest, error.x, error.y});
        }
  return largest;
}

double largest_error_fragments(const Sensor &sensor) {
  double largest = 0.0;
  const auto blocks = chip_blocks(sensor, 100); // several
  check_every_pixel_once(sensor, blocks);
  for (const RasterBlock &block : blocks) {
    CHECK_FALSE(block.distorted);
    CHECK(glm::all(glm::lessThanEqual(block.pixels * sensor.samples, glm::uvec2(100))));
    largest = std::max(largest, largest_error_fragments(sensor, block));
  }
  return largest;
}

Sensor flat_sensor(std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {90, 61};
  sensor.pixel_pitch_m = {2e-4, 3e-4};
  sensor.focal_length_m = 0.02;
  sensor.samples = samples;
  return sensor;
}

} // namespace

TEST_CASE("without distortion samples are the centres of fragments, however the chip stands") {
  for (const std::uint32_t samples : {1u, 2u, 3u, 16u}) {
    Sensor sensor = flat_sensor(samples);
    CHECK_FALSE(is_tiled(sensor));
    CHECK(largest_error_fragments(sensor) < 1e-9);
    sensor.focus_distance_m = 0.5;
    sensor.chip.rotation_rad = {10 * degree, -6 * degree, 33 * degree};
    CHECK(largest_error_fragments(sensor) < 1e-9);
    sensor.chip.translation_m = {1e-3, -4e-3, 2e-3};
    CHECK(largest_error_fragments(sensor) < 1e-9);
  }
}

TEST_CASE("of pixels filled in part samples are fragments moved to the raster's grid") {
  for (const std::uint32_t samples : {1u, 2u, 3u, 5u}) {
    Sensor sensor = flat_sensor(samples);
    sensor.fill_factor = {0.6, 0.37};
    sensor.chip.rotation_rad = {10 * degree, -6 * degree, 33 * degree};
    CHECK(is_tiled(sensor));
    CHECK(largest_error_fragments(sensor) < 1.0 / 512 + 1e-9);
    for (std::uint32_t k = 0; k < samples; ++k)
      CHECK(std::fmod(raster_shift(sensor, {k, 0}).x * 256.0f, 1.0f) == 0.0f);
  }
}

TEST_CASE("depth on a nominal chip's raster is depth before the lens") {
  const auto blocks = chip_blocks(flat_sensor(2), largest_block);
  REQUIRE(blocks.size() == 1);
  CHECK((blocks[0].raster_from_camera * glm::dvec3(0.3, -0.2, 1.7)).z == Approx(1.7).epsilon(1e-13));
}

namespace {

struct DistortedFigures {
  double nearest_border_fragments = 1e9; // of any sample, whole fragments between it and the border
  double narrowest_fragments = 1e9;      // between neighbouring samples, blocks of above 16 pixels only
  std::size_t large_blocks = 0;
};

constexpr std::uint32_t smallest_side = 16; // blocks of at most this many pixels a side have exceptions

bool is_large(const RasterBlock &block) { return std::max(block.pixels.x, block.pixels.y) > smallest_side; }

// The rows or columns of a side that are looked at: all of a short one, of a long one the ends and some
// between.
std::vector<std::uint32_t> steps_of(std::uint32_t samples) {
  std::vector<std::uint32_t> steps;
  for (std::uint32_t i = 0; i < samples; ++i)
    if (samples <= 40 || i < 3 || i + 3 >= samples || i % (samples / 31) == 0)
      steps.push_back(i);
  return steps;
}

glm::dvec2 sample_on_raster(const Sensor &sensor, const Lens &lens, const RasterBlock &block,
                            const glm::uvec2 &sample) {
  const glm::uvec2 pixel = block.first_pixel + sample / sensor.samples;
  return on_raster(block, *lens.ray(lens.on_chip_m(place_of(sensor, pixel, sample % sensor.samples))));
}

void look_at(const Sensor &sensor, const Lens &lens, const RasterBlock &block, DistortedFigures &figures) {
  const glm::uvec2 samples = block.pixels * sensor.samples;
  figures.large_blocks += is_large(block);
  for (const std::uint32_t row : steps_of(samples.y))
    for (const std::uint32_t column : steps_of(samples.x)) {
      const glm::dvec2 at = sample_on_raster(sensor, lens, block, {column, row});
      const glm::dvec2 whole = glm::floor(at), beyond = glm::dvec2(block.fragments) - 1.0 - whole;
      figures.nearest_border_fragments =
          std::min({figures.nearest_border_fragments, whole.x, whole.y, beyond.x, beyond.y});
      if (!is_large(block))
        continue;
      for (const glm::uvec2 step : {glm::uvec2(1, 0), glm::uvec2(0, 1)})
        if (const glm::uvec2 next = glm::uvec2(column, row) + step; glm::all(glm::lessThan(next, samples)))
          figures.narrowest_fragments = std::min(
              figures.narrowest_fragments, glm::distance(sample_on_raster(sensor, lens, block, next), at));
    }
}

void check_size(const Sensor &sensor, const RasterBlock &block) {
  CHECK(block.distorted);
  CHECK(glm::all(glm::lessThanEqual(block.fragments, glm::uvec2(largest_block))));
  const double samples = double(block.pixels.x) * block.pixels.y * sensor.samples * sensor.samples;
  CHECK((samples <= (1u << 20) || !is_large(block)));
  // Three fragments a sample and 65,536 to spare, and a margin of three and what rounding up adds.
  const glm::dvec2 inside = glm::dvec2(block.fragments) - 7.0;
  CHECK((glm::any(glm::lessThanEqual(inside, glm::dvec2(0.0))) ||
         inside.x * inside.y <= 3.0 * samples + 65536.0));
}

DistortedFigures check_distorted_blocks(const Sensor &sensor) {
  REQUIRE_FALSE(lens_fault(sensor));
  const auto blocks = distorted_blocks(sensor, largest_block);
  check_every_pixel_once(sensor, blocks);
  const Lens lens(sensor);
  DistortedFigures figures;
  // A fragment is as wide in pixels that are filled in part as in full ones.
  Sensor filled = sensor;
  filled.fill_factor = glm::dvec2(1.0);
  for (const RasterBlock &block : blocks) {
    check_size(sensor, block);
    look_at(filled, lens, block, figures);
  }
  // A sample's fragment has one more all around it, in the raster.
  CHECK(figures.nearest_border_fragments >= 1.0);
  CHECK(figures.narrowest_fragments >= 0.95);
  return figures;
}

// A lens so long that the image's corners lie at the given slope, of a fisheye at that angle.
Sensor sensor_to(double corner_slope, const Distortion &distortion, const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.pixel_pitch_m = glm::dvec2(1e-4);
  sensor.focal_length_m = 0.5 * glm::length(glm::dvec2(resolution) * 1e-4) / corner_slope;
  sensor.distortion = distortion;
  return sensor;
}

} // namespace

TEST_CASE("with distortion every sample has a fragment, no wider than itself, with eight around it") {
  Random random(41);
  int checked = 0;
  for (int i = 0; i < 80; ++i) {
    Sensor sensor = random_camera(random, {80 + 7 * i, 60 + 5 * i});
    sensor.samples = 1 + static_cast<std::uint32_t>(i % 3);
    if (!sensor.has_distortion() || lens_fault(sensor))
      continue;
    INFO("camera " << i);
    CHECK(check_distorted_blocks(sensor).large_blocks > 0);
    ++checked;
  }
  CHECK(checked > 20);
}

TEST_CASE("wide views and strong distortion are cut until their fragments are few") {
  const glm::uvec2 resolution(640, 480);
  SECTION("mild barrel: one block") {
    const Sensor sensor = sensor_to(0.4, BrownConrady{-0.1, 0, 0, 0, 0}, resolution);
    check_distorted_blocks(sensor);
    CHECK(distorted_blocks(sensor, largest_block).size() == 1);
  }
  SECTION("barrel near its fold") {
    check_distorted_blocks(
        sensor_to(0.999 * 2 / 3 * std::sqrt(1 / 0.9), BrownConrady{-0.3, 0, 0, 0, 0}, resolution));
  }
  SECTION("strong pincushion") {
    check_distorted_blocks(sensor_to(2.0, BrownConrady{0.8, 0, 0, 0, 0}, resolution));
  }
  SECTION("fisheye of 170 degrees") { check_distorted_blocks(sensor_to(85 * degree, Fisheye{}, resolution)); }
  SECTION("fisheye of 240 degrees") {
    check_distorted_blocks(sensor_to(120 * degree, Fisheye{}, resolution));
  }
  SECTION("fisheye of 350 degrees") {
    check_distorted_blocks(sensor_to(175 * degree, Fisheye{}, resolution));
  }
  SECTION("fisheye of 240 degrees with coefficients, 3 x 3 samples") {
    Sensor sensor = sensor_to(120 * degree, Fisheye{-0.03, 0.01, -0.004, 0.0005}, {200, 300});
    sensor.samples = 3;
    check_distorted_blocks(sensor);
  }
}

TEST_CASE("large frames are cut into blocks of at most 2^20 samples") {
  const auto blocks =
      distorted_blocks(sensor_to(0.4, BrownConrady{-0.1, 0, 0, 0, 0}, {4096, 1024}), largest_block);
  CHECK(blocks.size() == 4);
}

TEST_CASE("sensors of few pixels") {
  const glm::uvec2 resolution =
      GENERATE(glm::uvec2(1, 1), glm::uvec2(4, 4), glm::uvec2(1, 500), glm::uvec2(500, 1), glm::uvec2(2, 17));
  const std::uint32_t samples = GENERATE(1u, 2u, 5u, 16u);
  INFO(resolution.x << " x " << resolution.y << ", S = " << samples);
  const std::vector<Sensor> sensors{sensor_to(0.4, BrownConrady{-0.1, 0, 0, 0, 0}, resolution),
                                    sensor_to(0.4, BrownConrady{0.5, 0, 0.01, -0.02, 0}, resolution),
                                    sensor_to(0.7, BrownConrady{-0.3, 0, 0, 0, 0}, resolution),
                                    sensor_to(1.5, BrownConrady{0.8, 0, 0, 0, 0}, resolution),
                                    sensor_to(55 * degree, Fisheye{}, resolution)};
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    INFO("sensor " << i);
    Sensor sensor = sensors[i];
    sensor.samples = samples;
    check_distorted_blocks(sensor);
  }
}

TEST_CASE("a pixel that sees more than 120 degrees is a fault; without it every block has its plane") {
  for (const glm::uvec2 resolution :
       {glm::uvec2(1, 1), glm::uvec2(2, 2), glm::uvec2(1, 30), glm::uvec2(100, 1)})
    for (double corner_deg = 20; corner_deg < 179; corner_deg += 3) {
      INFO(resolution.x << " x " << resolution.y << ", corners at " << corner_deg << " degrees");
      const Sensor sensor = sensor_to(corner_deg * degree, Fisheye{}, resolution);
      const bool too_wide = lens_fault(sensor) == LensFault::pixel_too_wide;
      if (resolution == glm::uvec2(1, 1))
        CHECK(too_wide == (corner_deg >= 60));
      if (!too_wide)
        CHECK_NOTHROW(distorted_blocks(sensor, largest_block));
    }
}
