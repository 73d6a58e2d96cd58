#include "host/bench/real/pixel_check.h"

#include "host/bench/distance_errors.h"
#include "host/capture/camera.h"
#include "host/capture/progress.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pmdsim {
namespace {

using Pixels = std::vector<std::uint32_t>;

reference::Frame true_pixels(const Setup &setup, const Sensor &sensor,
                             const std::vector<Illuminator> &illuminators, const Pixels &pixels) {
  return reference::simulate(
      setup.start.scene, sensor, illuminators, setup.backscatter,
      {.shadows = setup.shadows, .keep_visibility = setup.shadows == Shadows::automatic, .pixels = pixels},
      [](double) { throw_if_interrupted(); });
}

// The data that compare() asks for, as a frame of one column.
Measurement at_pixels(const Measurement &frame, const Pixels &pixels) {
  Measurement some;
  some.accuracy = frame.accuracy;
  some.returns.resize(1);
  const std::size_t words = frame.sample_visibility.size() / frame.sample_triangle_id.size();
  for (const std::uint32_t pixel : pixels) {
    some.returns[0].distance_m.push_back(frame.returns[0].distance_m[pixel]);
    some.sample_triangle_id.push_back(frame.sample_triangle_id[pixel]);
    const auto first = frame.sample_visibility.begin() + static_cast<std::ptrdiff_t>(pixel * words);
    some.sample_visibility.insert(some.sample_visibility.end(), first,
                                  first + static_cast<std::ptrdiff_t>(words));
  }
  return some;
}

// Pixels in which pairs are apart, and which pairs: bits of their words.
struct PairsApart {
  Pixels pixels;
  std::vector<std::uint32_t> triangles, reached, apart; // by the reference, by the reference, not by both
};

PairsApart pairs_apart(const Measurement &found, const reference::Frame &truth, const Pixels &pixels) {
  PairsApart pairs;
  const std::size_t words = truth.sample_visibility.size() / pixels.size();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto of_pixel = [&](const std::vector<std::uint32_t> &bits) { return bits.data() + i * words; };
    const std::uint32_t *expected = of_pixel(truth.sample_visibility),
                        *got = of_pixel(found.sample_visibility);
    if (truth.sample_triangle_id[i] == no_id || found.sample_triangle_id[i] != truth.sample_triangle_id[i] ||
        std::equal(expected, expected + words, got))
      continue;
    pairs.pixels.push_back(pixels[i]);
    pairs.triangles.push_back(truth.sample_triangle_id[i]);
    for (std::size_t word = 0; word < words; ++word) {
      pairs.reached.push_back(expected[word]);
      pairs.apart.push_back(expected[word] ^ got[word]);
    }
  }
  return pairs;
}

// Takes out of `pairs.apart` what the reference decides otherwise once points and diodes have moved.
void leave_out_rounding(PairsApart &pairs, const Setup &setup, Sensor sensor, const glm::dvec3 &side) {
  std::vector<Illuminator> illuminators = setup.start.illuminators;
  sensor.world_from_camera.translation_m += rounding_of_point_m * side;
  for (Illuminator &illuminator : illuminators)
    illuminator.world_from_illuminator.translation_m -= rounding_of_diode_m * side;
  const reference::Frame moved = true_pixels(setup, sensor, illuminators, pairs.pixels);
  const std::size_t words = pairs.apart.size() / pairs.pixels.size();
  for (std::size_t i = 0; i < pairs.apart.size(); ++i)
    pairs.apart[i] &= moved.sample_triangle_id[i / words] == pairs.triangles[i / words]
                          ? ~(moved.sample_visibility[i] ^ pairs.reached[i])
                          : 0u;
}

} // namespace

PixelCheck check_pixels(const Setup &setup, const Measurement &frame, const Pixels &pixels) {
  const Sensor &sensor = setup.start.sensors.front();
  const std::vector<Illuminator> &illuminators = setup.start.illuminators;
  const Measurement found = at_pixels(frame, pixels);
  const reference::Frame truth = true_pixels(setup, sensor, illuminators, pixels);
  PairsApart pairs = pairs_apart(found, truth, pixels);
  for (const glm::dvec3 &side : std::array<glm::dvec3, 4>{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}})
    if (!pairs.pixels.empty())
      leave_out_rounding(pairs, setup, sensor, side);
  Sensor column = sensor;
  column.resolution = truth.resolution;
  PixelCheck check{compare(found, truth, column, 0, diode_count(illuminators))};
  for (const std::uint32_t bits : pairs.apart)
    check.pairs_beyond_rounding += static_cast<std::size_t>(std::popcount(bits));
  return check;
}

PixelCheck check_some_pixels(const Setup &setup, const BenchRequest &request) {
  const Sensor &sensor = setup.start.sensors.front();
  Camera camera(request.device, {.sample_triangles = true, .reached = setup.shadows == Shadows::automatic});
  camera.prepare(setup, sensor, request.accuracy);
  const auto pixels = static_cast<double>(sensor.pixel_count());
  return check_pixels(
      setup, camera.measure([](double) { throw_if_interrupted(); }),
      random_pixels(sensor.pixel_count(), static_cast<std::size_t>(std::ceil(checked_share * pixels))));
}

} // namespace pmdsim
