// What images may hold: gaps, darkness, several turns, noise.

#include "tests/correction/forward.h"

#include <catch2/catch.hpp>
#include <random>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("pixels without a number stay without", "[smoke]") {
  const Sensor sensor = camera({30, 20}, 40.0);
  const std::vector<Illuminator> light{ring(0.1, 8)};
  Taken taken = take(sensor, light, wall({0, 0, 2}, {0.1, 0.2, -1}));
  taken.image.phase_rad[215] = std::nan("");
  taken.image.phase_rad[216] = std::numeric_limits<double>::infinity();
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(count(corrected, PixelStatus::not_measured) == 2);
  CHECK(std::isnan(corrected.range_m[215]));
  CHECK(std::isnan(corrected.correction_m[216]));
  CHECK(corrected.counts[0] + corrected.counts[1] == 598);
  CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
}

TEST_CASE("a ray that no diode reaches has no range") {
  const Sensor sensor = camera({10, 10}, 20.0);
  Illuminator away = ring(0.1, 8, {.kind = Pattern::Kind::cosine, .order = 1.0});
  for (Diode &diode : away.diodes)
    diode.axis = {0, 0, -1};
  const MeasuredImage image{std::vector<double>(100, 1.0)};
  const CorrectedImage corrected = correct(sensor, {away}, image, {});
  CHECK(count(corrected, PixelStatus::no_light) == 100);
  CHECK(std::isnan(corrected.range_m[0]));
}

TEST_CASE("images of nothing, of one pixel and of one row") {
  const std::vector<Illuminator> light{ring(0.1, 8)};
  for (const glm::uvec2 resolution :
       {glm::uvec2(1, 1), glm::uvec2(7, 1), glm::uvec2(1, 7), glm::uvec2(2, 2)}) {
    const Sensor sensor = camera(resolution, 20.0);
    const Taken taken = take(sensor, light, wall({0, 0, 2}, {0, 0, -1}));
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    CHECK(corrected.counts[0] + corrected.counts[1] == sensor.pixel_count());
    const MeasuredImage nothing{std::vector<double>(sensor.pixel_count(), std::nan(""))};
    CHECK(count(correct(sensor, light, nothing, {}), PixelStatus::not_measured) == sensor.pixel_count());
  }
}

TEST_CASE("the turn of a phase: the least range, a guess, or none") {
  const Sensor sensor = camera({30, 20}, 40.0);
  const std::vector<Illuminator> light{ring(0.1, 8)};
  const double ambiguity_m = sensor.ambiguity_m();
  const Taken taken = take(sensor, light, wall({0, 0, ambiguity_m + 2.0}, {0.1, 0.2, -1}));
  const CorrectedImage nearest = correct(sensor, light, taken.image, {});
  CHECK(largest_error_m(nearest, taken.range_m) > 1.0);
  const CorrectedImage farther = correct(sensor, light, taken.image, {.least_range_m = 6.0});
  CHECK(largest_error_m(farther, taken.range_m) < solved_m);
  CHECK(count(farther, PixelStatus::corrected) == 600);

  MeasuredImage guessed = taken.image;
  guessed.guess_m = taken.range_m;
  for (std::size_t pixel = 0; pixel < guessed.guess_m.size(); ++pixel)
    guessed.guess_m[pixel] += (pixel % 2 == 0 ? 0.4 : -0.4) * ambiguity_m;
  CHECK(largest_error_m(correct(sensor, light, guessed, {}), taken.range_m) < solved_m);
}

TEST_CASE(
    "a wall across the end of the ambiguity range, where the diodes' path is in the next turn already") {
  const Sensor sensor = camera({30, 20}, 300.0);
  const std::vector<Illuminator> light{ring(0.3, 8)};
  const Taken taken = take(sensor, light, wall({0, 0, sensor.ambiguity_m() - 0.02}, {0, 0, -1}));
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(largest_error_m(corrected, taken.range_m) < solved_m);
  CHECK(corrected.correction_m[310] > 0.0);
  CHECK(corrected.correction_m[310] < 0.01);
}

TEST_CASE("the second frequency of two") {
  Sensor sensor = camera({30, 20}, 40.0);
  sensor.modulation_hz = {20e6, 50e6};
  const std::vector<Illuminator> light{ring(0.1, 8)};
  const Taken taken = take(sensor, light, wall({0, 0, 2}, {0.1, 0.2, -1}), Backscatter::lambert, 1);
  CHECK(largest_error_m(correct(sensor, light, taken.image, {.frequency = 1}), taken.range_m) < solved_m);
}

TEST_CASE("noise goes through, and normals are taken from more pixels") {
  const Sensor sensor = camera({120, 100}, 150.0);
  const std::vector<Illuminator> light{ring(0.15, 24)};
  Taken taken = take(sensor, light, wall({0, 0, 2}, {0.4, 0.2, -1}));
  std::mt19937 random(5);
  constexpr double noise_m = 2e-3;
  std::normal_distribution<double> off_rad(0.0, phase_of_distance_rad(noise_m, sensor.modulation_hz[0]));
  for (double &phase_rad : taken.image.phase_rad)
    phase_rad += off_rad(random);
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(corrected.noise_m == Approx(noise_m).epsilon(0.1));
  CHECK(corrected.fit_pixels > 1);
  double sum_m = 0.0, squares = 0.0;
  for (std::size_t pixel = 0; pixel < taken.range_m.size(); ++pixel) {
    const double off_m = corrected.range_m[pixel] - taken.range_m[pixel];
    sum_m += off_m;
    squares += off_m * off_m;
  }
  const auto pixels = static_cast<double>(taken.range_m.size());
  CHECK(std::abs(sum_m / pixels) < 5.0 * noise_m / std::sqrt(pixels));
  CHECK(std::sqrt(squares / pixels) == Approx(noise_m).epsilon(0.05));
}

TEST_CASE("noise goes through, and nothing more, where a pixel has an area") {
  Sensor sensor = camera({120, 100}, 150.0);
  const std::vector<Illuminator> light{ring(0.15, 24)};
  const SurfaceFormula surface = both(ball({0, 0, 2}, 0.4), wall({0, 0, 2.5}, {0.4, 0.2, -1}));
  constexpr double noise_m = 5e-3;
  for (const std::uint32_t samples : {1u, 2u, 4u, 16u}) {
    sensor.samples = 4;
    Taken taken = take(sensor, light, surface);
    sensor.samples = samples;
    std::mt19937 random(5);
    std::normal_distribution<double> off_m(0.0, noise_m);
    std::vector<double> noisy_range_m = taken.range_m;
    for (std::size_t pixel = 0; pixel < noisy_range_m.size(); ++pixel) {
      const double off = off_m(random);
      taken.image.phase_rad[pixel] += phase_of_distance_rad(off, sensor.modulation_hz[0]);
      noisy_range_m[pixel] += off;
    }
    const CorrectedImage corrected = correct(sensor, light, taken.image, {});
    CHECK(corrected.edge_limit_m < noise_m);
    double squares = 0.0;
    for (std::size_t pixel = 0; pixel < noisy_range_m.size(); ++pixel)
      if (corrected.status[pixel] == static_cast<std::uint32_t>(PixelStatus::corrected))
        squares += std::pow(corrected.range_m[pixel] - noisy_range_m[pixel], 2);
    INFO(samples);
    CHECK(count(corrected, PixelStatus::corrected) > 6000);
    CHECK(std::sqrt(squares / static_cast<double>(count(corrected, PixelStatus::corrected))) <
          0.02 * noise_m);
  }
}

TEST_CASE("an image of steps is no less noisy than its steps") {
  const Sensor sensor = camera({120, 100}, 150.0);
  const std::vector<Illuminator> light{ring(0.15, 24, {}, {0.05, 0.0, 0.0})};
  Taken taken = take(sensor, light, wall({0, 0, 2}, {0, 0, -1}));
  constexpr double step_m = 1e-3;
  std::vector<double> stepped_range_m = taken.range_m;
  for (std::size_t pixel = 0; pixel < stepped_range_m.size(); ++pixel) {
    double &phase_rad = taken.image.phase_rad[pixel];
    const double distance_m = distance_of_phase_m(phase_rad, sensor.modulation_hz[0]),
                 stepped_m = step_m * std::round(distance_m / step_m);
    phase_rad = phase_of_distance_rad(stepped_m, sensor.modulation_hz[0]);
    stepped_range_m[pixel] += stepped_m - distance_m;
  }
  taken.image.step_m = step_m;
  const CorrectedImage corrected = correct(sensor, light, taken.image, {});
  CHECK(corrected.noise_m >= step_m / std::sqrt(12.0));
  CHECK(count(corrected, PixelStatus::edge) < 500); // without, half of 12,000
  CHECK(largest_error_m(corrected, stepped_range_m) < 0.1 * step_m);
}

TEST_CASE("the same image gives the same bits") {
  const Sensor sensor = camera({60, 50}, 80.0);
  const std::vector<Illuminator> light{ring(0.15, 24)};
  const Taken taken = take(sensor, light, both(ball({0, 0, 1.5}, 0.3), wall({0, 0, 2.5}, {0, 0, -1})));
  const CorrectedImage first = correct(sensor, light, taken.image, {}),
                       second = correct(sensor, light, taken.image, {});
  CHECK(first.range_m.size() == 3000);
  for (std::size_t pixel = 0; pixel < first.range_m.size(); ++pixel)
    if (!(first.range_m[pixel] == second.range_m[pixel]))
      CHECK((std::isnan(first.range_m[pixel]) && std::isnan(second.range_m[pixel])));
}

TEST_CASE("an image of another size is a mistake of our own") {
  const Sensor sensor = camera({10, 10}, 20.0);
  CHECK_THROWS_AS(correct(sensor, {ring(0.1, 8)}, MeasuredImage{std::vector<double>(99, 1.0)}, {}),
                  std::logic_error);
}
