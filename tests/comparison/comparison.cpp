#include "tests/comparison/comparison.h"

#include "tests/comparison/projected_edges.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim::test {

namespace {

double relative_error(float measured, double expected) {
  return std::abs(measured - expected) / std::abs(expected);
}

bool same_light(const Return &measured, const reference::FrameReturn &expected, std::size_t pixel) {
  const bool lit = expected.amplitude[pixel] > 0;
  return (measured.amplitude[pixel] > 0) == lit && std::isfinite(measured.phase_rad[pixel]) == lit &&
         std::isfinite(measured.distance_m[pixel]) == lit;
}

bool same_truth(const Measurement &measured, const reference::Frame &expected, std::size_t pixel) {
  const bool hit = expected.coverage[pixel] > 0;
  bool same = measured.coverage[pixel] == static_cast<float>(expected.coverage[pixel]) &&
              measured.triangle_id[pixel] == expected.triangle_id[pixel] &&
              measured.object_id[pixel] == expected.object_id[pixel] &&
              std::isfinite(measured.range_m[pixel]) == hit && std::isfinite(measured.z_m[pixel]) == hit;
  for (std::size_t f = 0; f < expected.returns.size(); ++f)
    same = same && same_light(measured.returns[f], expected.returns[f], pixel);
  return same;
}

// Everything that one comparison reads, and the result as it grows.
class Comparing {
public:
  Comparing(const Measurement &measured, const reference::Frame &expected, const Scene &scene,
            const Sensor &sensor)
      : measured_(measured), expected_(expected), scene_(scene), sensor_(sensor), lens_(sensor),
        triangles_(reference::triangles_in_camera(scene, sensor)) {}

  // Compares the samples of a pixel; true where all see the same.
  bool compare_samples(const glm::uvec2 &pixel) {
    const std::size_t differing_before = result_.differing_samples;
    for (std::uint32_t row = 0; row < sensor_.samples; ++row)
      for (std::uint32_t column = 0; column < sensor_.samples; ++column)
        compare_sample(pixel * sensor_.samples + glm::uvec2(column, row));
    return result_.differing_samples == differing_before;
  }

  void compare_truth(std::size_t pixel) {
    result_.disagreements += !same_truth(measured_, expected_, pixel);
    if (expected_.coverage[pixel] > 0)
      result_.range_max_relative = std::max(
          {result_.range_max_relative, relative_error(measured_.range_m[pixel], expected_.range_m[pixel]),
           relative_error(measured_.z_m[pixel], expected_.z_m[pixel])});
  }

  void compare_light(std::size_t pixel) {
    for (std::size_t f = 0; f < expected_.returns.size(); ++f)
      compare_light(measured_.returns[f], expected_.returns[f], sensor_.ambiguity_m(f), pixel);
  }

  Comparison result() const {
    Comparison result = result_;
    if (result.pixels > 0)
      result.distance_rms_m = std::sqrt(squares_m2_ / static_cast<double>(result.pixels));
    return result;
  }

private:
  void compare_light(const Return &measured, const reference::FrameReturn &expected, double ambiguity_m,
                     std::size_t pixel) {
    if (expected.amplitude[pixel] == 0)
      return;
    const double distance_error_m =
        std::abs(std::remainder(measured.distance_m[pixel] - expected.distance_m[pixel], ambiguity_m));
    ++result_.pixels;
    squares_m2_ += distance_error_m * distance_error_m;
    result_.distance_max_m = std::max(result_.distance_max_m, distance_error_m);
    result_.amplitude_max_relative = std::max(
        result_.amplitude_max_relative, relative_error(measured.amplitude[pixel], expected.amplitude[pixel]));
    for (std::size_t k = 0; k < measured.taps.size(); ++k)
      result_.amplitude_max_relative =
          std::max(result_.amplitude_max_relative,
                   std::abs(measured.taps[k][pixel] - expected.taps[k][pixel]) / expected.amplitude[pixel]);
  }

  void compare_sample(const glm::uvec2 &sample) {
    const std::size_t index = std::size_t{sample.y} * sensor_.samples * sensor_.resolution.x + sample.x;
    const std::uint32_t measured = measured_.sample_triangle_id[index];
    const std::uint32_t expected = expected_.sample_triangle_id[index];
    ++result_.samples;
    if (measured == expected)
      return;
    ++result_.differing_samples;
    result_.differing_far_off += !near_edge(sample, measured) && !near_edge(sample, expected);
  }

  bool near_edge(const glm::uvec2 &sample, std::uint32_t id) const {
    if (id == no_id)
      return false;
    if (id < triangles_.size())
      return pixels_to_edge(lens_, sensor_, sample, triangles_[id]) <= 1.0;
    return pixels_to_rim(lens_, sensor_, sample, centre_m(id), disc(id).radius_m) <= 1.0;
  }

  const Disc &disc(std::uint32_t id) const { return scene_.discs[id - triangles_.size()]; }
  glm::dvec3 centre_m(std::uint32_t id) const {
    return inverse(sensor_.world_from_camera).point(scene_.positions_m[disc(id).vertex]);
  }

  const Measurement &measured_;
  const reference::Frame &expected_;
  const Scene &scene_;
  const Sensor &sensor_;
  reference::LensModel lens_;
  std::vector<reference::CameraTriangle> triangles_;
  Comparison result_;
  double squares_m2_ = 0.0;
};

} // namespace

Comparison compare(const Measurement &measured, const reference::Frame &expected, const Scene &scene,
                   const Sensor &sensor, const std::vector<bool> &left_out) {
  Comparing comparing(measured, expected, scene, sensor);
  for (std::size_t pixel = 0; pixel < sensor.pixel_count(); ++pixel) {
    if (!comparing.compare_samples({pixel % sensor.resolution.x, pixel / sensor.resolution.x}))
      continue;
    const bool compare_light = left_out.empty() || !left_out[pixel];
    if (compare_light) {
      comparing.compare_truth(pixel);
      comparing.compare_light(pixel);
    }
  }
  return comparing.result();
}

void check_values(const Comparison &comparison, std::size_t pixels) {
  CHECK(comparison.pixels >= pixels);
  CHECK(comparison.distance_max_m <= 2e-6);
  CHECK(comparison.distance_rms_m <= 0.3e-6);
  CHECK(comparison.amplitude_max_relative <= 1e-5);
  CHECK(comparison.range_max_relative <= 1e-6);
  CHECK(comparison.disagreements == 0);
  CHECK(comparison.differing_far_off == 0);
}

void check_comparison(const Comparison &comparison, std::size_t pixels) {
  check_values(comparison, pixels);
  CHECK(comparison.differing_fraction() <= 1e-3);
}

std::string comparison_heading() {
  return fmt::format("{:<40}{:>10}{:>12}{:>12}{:>14}{:>12}{:>13}{:>9}\n", "against the reference", "pixels",
                     "max um", "RMS um", "amplitude", "range", "triangles %", "far off");
}

std::string comparison_row(const std::string &name, const Comparison &comparison) {
  return fmt::format("{:<40}{:>10}{:>12.4f}{:>12.4f}{:>14.2e}{:>12.2e}{:>13.5f}{:>9}\n", name,
                     comparison.pixels, 1e6 * comparison.distance_max_m, 1e6 * comparison.distance_rms_m,
                     comparison.amplitude_max_relative, comparison.range_max_relative,
                     100 * comparison.differing_fraction(), comparison.differing_far_off);
}

} // namespace pmdsim::test
