#include "host/bench/distance_errors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace pmdsim {
namespace {

constexpr std::uint64_t pixel_seed = 20070101; // any, but always the same

// Every triangle that the pixel's samples see in a frame of so many columns.
void add_triangles(std::set<std::uint32_t> &triangles, const std::vector<std::uint32_t> &sample_triangle_id,
                   std::size_t columns, std::size_t pixel, std::size_t samples) {
  const std::size_t row = pixel / columns * samples, column = pixel % columns * samples;
  for (std::size_t k = 0; k < samples * samples; ++k)
    triangles.insert(sample_triangle_id[(row + k / samples) * columns * samples + column + k % samples]);
}

DistanceErrors errors_of(const std::vector<double> &errors_m) {
  if (errors_m.empty())
    return {};
  const double square_sum_m2 = std::inner_product(errors_m.begin(), errors_m.end(), errors_m.begin(), 0.0);
  return {errors_m.size(), std::ranges::max(errors_m),
          std::sqrt(square_sum_m2 / static_cast<double>(errors_m.size()))};
}

} // namespace

// Floyd's algorithm.
std::vector<std::uint32_t> random_pixels(std::uint64_t pixels, std::size_t count) {
  std::set<std::uint32_t> chosen;
  std::mt19937_64 random(pixel_seed);
  for (std::uint64_t last = pixels - std::min<std::uint64_t>(pixels, count); last < pixels; ++last) {
    const auto pixel = static_cast<std::uint32_t>(random() % (last + 1));
    if (!chosen.insert(pixel).second)
      chosen.insert(static_cast<std::uint32_t>(last));
  }
  return {chosen.begin(), chosen.end()};
}

std::vector<bool> on_edges(const TruePixels &truth, const Measurement &found, std::uint32_t samples,
                           std::size_t diodes) {
  const auto true_samples = truth.sensor.samples;
  // The change of a pixel's `lit` by one diode more or less at one sample.
  const double least_lit = 1.0 / (static_cast<double>(diodes) * true_samples * true_samples);
  std::vector<bool> edges;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    std::set<std::uint32_t> triangles;
    add_triangles(triangles, truth.frame.sample_triangle_id, 1, i, true_samples);
    add_triangles(triangles, found.sample_triangle_id, truth.sensor.resolution.x, truth.pixels[i], samples);
    const bool other_light = !found.lit.empty() && std::abs(static_cast<double>(found.lit[truth.pixels[i]]) -
                                                            truth.frame.lit[i]) > 0.5 * least_lit;
    edges.push_back(triangles.size() > 1 || other_light);
  }
  return edges;
}

ErrorsByPlace distance_errors(const TruePixels &truth, const std::vector<bool> &edges,
                              const Measurement &found) {
  const reference::FrameReturn &expected = truth.frame.returns.front();
  const Return &of = found.returns.front();
  std::vector<double> beside_m, on_m;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    if (std::isnan(expected.distance_m[i]))
      continue;
    const double found_m = of.unrounded_distance_m.empty()
                               ? static_cast<double>(of.distance_m[truth.pixels[i]])
                               : of.unrounded_distance_m[truth.pixels[i]];
    const double error_m =
        std::isfinite(found_m)
            ? std::abs(std::remainder(found_m - expected.distance_m[i], expected.ambiguity_m))
            : 0.5 * expected.ambiguity_m;
    (edges[i] ? on_m : beside_m).push_back(error_m);
  }
  return {errors_of(beside_m), errors_of(on_m)};
}

} // namespace pmdsim
