#include "tests/comparison/visibility_comparison.h"

#include "tests/comparison/shadow_clearance.h"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim::test {

namespace {

// Everything that one comparison reads, and the result as it grows.
class ComparingReached {
public:
  ComparingReached(const Measurement &measured, const reference::Frame &expected, const Scene &scene,
                   const Sensor &sensor, const std::vector<Illuminator> &illuminators)
      : measured_(measured), expected_(expected), sensor_(sensor), diodes_(diode_count(illuminators)),
        words_((diodes_ + 31) / 32), clearances_(scene, sensor, illuminators) {
    result_.differing_pixels.assign(sensor.pixel_count(), false);
    const std::size_t samples = sensor.pixel_count() * sensor.samples * sensor.samples;
    REQUIRE(measured.sample_visibility.size() == samples * words_);
    REQUIRE(expected.sample_visibility.size() == samples * words_);
    REQUIRE(measured.lit.size() == sensor.pixel_count());
    REQUIRE(expected.lit.size() == sensor.pixel_count());
  }

  void compare_pixel(const glm::uvec2 &pixel) {
    const std::size_t differing_before = result_.differing_pairs;
    std::size_t hits = 0, reached = 0;
    for (std::uint32_t row = 0; row < sensor_.samples; ++row)
      for (std::uint32_t column = 0; column < sensor_.samples; ++column) {
        const glm::uvec2 sample = pixel * sensor_.samples + glm::uvec2(column, row);
        hits += measured_.sample_triangle_id[index_of(sample)] != no_id;
        reached += reached_count(measured_.sample_visibility, sample);
        compare_sample(sample);
      }
    const std::size_t index = std::size_t{pixel.y} * sensor_.resolution.x + pixel.x;
    result_.differing_pixels[index] = result_.differing_pairs > differing_before;
    const double lit = hits > 0 ? static_cast<double>(reached) / static_cast<double>(hits * diodes_) : 0.0;
    result_.lit_error = std::max(result_.lit_error, std::abs(measured_.lit[index] - lit));
  }

  const ReachedComparison &result() const { return result_; }

private:
  std::size_t index_of(const glm::uvec2 &sample) const {
    return std::size_t{sample.y} * sensor_.samples * sensor_.resolution.x + sample.x;
  }

  std::size_t reached_count(const std::vector<std::uint32_t> &reached, const glm::uvec2 &sample) const {
    std::size_t count = 0;
    for (std::size_t word = 0; word < words_; ++word)
      count += static_cast<std::size_t>(std::popcount(reached[index_of(sample) * words_ + word]));
    return count;
  }

  void compare_sample(const glm::uvec2 &sample) {
    const std::size_t index = index_of(sample);
    const std::uint32_t id = expected_.sample_triangle_id[index];
    if (id == no_id || measured_.sample_triangle_id[index] != id)
      return;
    ++result_.samples;
    result_.pairs += diodes_;
    result_.reached += reached_count(expected_.sample_visibility, sample);
    for (std::size_t word = 0; word < words_; ++word) {
      std::uint32_t differing = measured_.sample_visibility[index * words_ + word] ^
                                expected_.sample_visibility[index * words_ + word];
      for (; differing != 0; differing &= differing - 1)
        count_differing(sample, id, 32 * word + static_cast<std::size_t>(std::countr_zero(differing)));
    }
  }

  void count_differing(const glm::uvec2 &sample, std::uint32_t id, std::size_t diode) {
    ++result_.differing_pairs;
    // Who is wrong about so many is wrong; brute force would take the day.
    constexpr std::size_t most = 20'000;
    if (result_.differing_pairs > most) {
      ++result_.clear_of_edges;
      ++result_.clear_of_all;
      return;
    }
    const ShadowClearance clearance = clearances_.of(sample, id, diode);
    const bool clear_of_edges = clearance.edge_m > rounding_distance_m;
    result_.clear_of_edges += clear_of_edges;
    result_.clear_of_all += clear_of_edges && clearance.end_m > rounding_distance_m;
  }

  const Measurement &measured_;
  const reference::Frame &expected_;
  const Sensor &sensor_;
  std::size_t diodes_, words_;
  ShadowClearances clearances_;
  ReachedComparison result_;
};

} // namespace

ReachedComparison compare_reached(const Measurement &measured, const reference::Frame &expected,
                                  const Scene &scene, const Sensor &sensor,
                                  const std::vector<Illuminator> &illuminators) {
  ComparingReached comparing(measured, expected, scene, sensor, illuminators);
  for (glm::uvec2 pixel(0); pixel.y < sensor.resolution.y; ++pixel.y)
    for (pixel.x = 0; pixel.x < sensor.resolution.x; ++pixel.x)
      comparing.compare_pixel(pixel);
  return comparing.result();
}

double share_of_pixels_agreeing(const Measurement &measured, const reference::Frame &expected) {
  std::size_t lit = 0, agreeing = 0;
  for (std::size_t f = 0; f < expected.returns.size(); ++f)
    for (std::size_t pixel = 0; pixel < expected.lit.size(); ++pixel) {
      if (measured.returns[f].amplitude[pixel] == 0 && expected.returns[f].amplitude[pixel] == 0)
        continue;
      ++lit;
      const double error_m =
          std::remainder(measured.returns[f].distance_m[pixel] - expected.returns[f].distance_m[pixel],
                         expected.returns[f].ambiguity_m);
      agreeing += std::abs(error_m) <= 3e-6; // not where one is NaN
    }
  return static_cast<double>(agreeing) / static_cast<double>(lit);
}

std::string reached_heading() {
  return fmt::format("{:<40}{:>12}{:>11}{:>11}{:>11}{:>12}{:>9}\n", "which diodes reach which sample",
                     "pairs", "reached %", "differing", "ppm", "clear edges", "clear");
}

std::string reached_row(const std::string &name, const ReachedComparison &comparison) {
  const double pairs = static_cast<double>(std::max<std::size_t>(1, comparison.pairs));
  return fmt::format("{:<40}{:>12}{:>11.2f}{:>11}{:>11.3f}{:>12}{:>9}\n", name, comparison.pairs,
                     100 * static_cast<double>(comparison.reached) / pairs, comparison.differing_pairs,
                     1e6 * comparison.differing_fraction(), comparison.clear_of_edges,
                     comparison.clear_of_all);
}

} // namespace pmdsim::test
