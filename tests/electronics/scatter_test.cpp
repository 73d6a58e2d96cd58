// Scatter inside the camera beside the sum that it stands for.

#include "engine/electronics/scatter.h"
#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>
#include <complex>
#include <fmt/format.h>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Sensor scattering_sensor() {
  Sensor sensor;
  sensor.resolution = {37, 23};
  sensor.pixel_pitch_m = {10e-6, 12e-6};
  sensor.scatter = {{0.05, 40e-6}, {0.02, 150e-6}, {0.1, 3e-6}};
  return sensor;
}

// A bright patch among faint ones, each with a phase of its own.
Measurement patches(const Sensor &sensor) {
  Measurement frame;
  frame.resolution = sensor.resolution;
  Return &of = frame.returns.emplace_back();
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const bool bright = column > 20 && column < 27 && row > 8 && row < 14;
      of.amplitude.push_back(bright ? 5.0f : 0.02f * static_cast<float>(column % 5));
      of.phase_rad.push_back(bright ? 1.0f : 0.1f * static_cast<float>(row));
      of.distance_m.push_back(0.0f);
      frame.mean_radiance.push_back(of.amplitude.back() / 0.8f);
    }
  return frame;
}

// The part of a Gaussian on a pixel so many columns or rows away.
double part(double away, double pitch_m, double sigma_m) {
  const double scale = pitch_m / (std::numbers::sqrt2 * sigma_m);
  return 0.5 * (std::erf((away + 0.5) * scale) - std::erf((away - 0.5) * scale));
}

double kernel(const Sensor &sensor, double columns, double rows) {
  const bool here = columns == 0.0 && rows == 0.0;
  double sum = here ? 1.0 : 0.0;
  for (const ScatterLobe &lobe : sensor.scatter)
    sum += lobe.share * (part(columns, sensor.pixel_pitch_m.x, lobe.sigma_m) *
                             part(rows, sensor.pixel_pitch_m.y, lobe.sigma_m) -
                         (here ? 1.0 : 0.0));
  return sum;
}

template <class Value>
Value convolved(const Sensor &sensor, std::uint32_t column, std::uint32_t row,
                const std::vector<Value> &image) {
  Value sum{};
  for (std::uint32_t y = 0; y < sensor.resolution.y; ++y)
    for (std::uint32_t x = 0; x < sensor.resolution.x; ++x)
      sum += kernel(sensor, double(column) - double(x), double(row) - double(y)) *
             image[std::size_t{y} * sensor.resolution.x + x];
  return sum;
}

} // namespace

TEST_CASE("scatter is the convolution with its lobes, of complex returns and of the mean light") {
  const Sensor sensor = scattering_sensor();
  const Measurement clear = patches(sensor);
  std::vector<std::complex<double>> z;
  for (std::size_t i = 0; i < clear.mean_radiance.size(); ++i)
    z.push_back(std::polar(double(clear.returns[0].amplitude[i]), double(clear.returns[0].phase_rad[i])));
  const std::vector<double> mean(clear.mean_radiance.begin(), clear.mean_radiance.end());
  Measurement found = clear;
  scatter(sensor, found);
  double largest = 0.0;
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      const std::size_t i = std::size_t{row} * sensor.resolution.x + column;
      const Return &of = found.returns[0];
      const auto expected = convolved(sensor, column, row, z);
      largest = std::max(largest,
                         std::abs(std::polar(double(of.amplitude[i]), double(of.phase_rad[i])) - expected));
      largest =
          std::max(largest, std::abs(double(found.mean_radiance[i]) - convolved(sensor, column, row, mean)));
    }
  fmt::print("scatter beside its sum: off by at most {:.2e} of the brightest pixel\n", largest / 5.0);
  CHECK(largest < 5.0 * 5e-6);
  // A faint pixel beside the bright patch is pulled towards its phase.
  const std::size_t beside = 9 * 37 + 28;
  CHECK(clear.returns[0].phase_rad[beside] == Approx(0.9));
  CHECK(found.returns[0].phase_rad[beside] > 0.93f);
  CHECK(found.returns[0].phase_rad[beside] < 1.0f);
}

TEST_CASE("taps scatter as the return does, and light that leaves the chip is lost") {
  const Sensor sensor = scattering_sensor();
  Measurement frame = patches(sensor);
  Return &of = frame.returns[0];
  for (std::uint32_t k = 0; k < 3; ++k) {
    of.taps.emplace_back();
    for (std::size_t i = 0; i < of.amplitude.size(); ++i)
      of.taps[k].push_back(of.amplitude[i] *
                           std::cos(of.phase_rad[i] - 2.0f * std::numbers::pi_v<float> * float(k) / 3.0f));
  }
  const std::vector<float> mean = frame.mean_radiance;
  scatter(sensor, frame);
  for (std::uint32_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < of.amplitude.size(); ++i)
      CHECK(of.taps[k][i] ==
            Approx(of.amplitude[i] *
                   std::cos(of.phase_rad[i] - 2.0f * std::numbers::pi_v<float> * float(k) / 3.0f))
                .margin(2e-5));
  double before = 0.0, after = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    before += mean[i];
    after += frame.mean_radiance[i];
  }
  CHECK(after < before);
  CHECK(after > 0.98 * before);
}

TEST_CASE("scatter has the same bits in every run") {
  const Sensor sensor = scattering_sensor();
  Measurement first = patches(sensor), second = first;
  scatter(sensor, first);
  scatter(sensor, second);
  CHECK(first.returns[0].phase_rad == second.returns[0].phase_rad);
  CHECK(first.mean_radiance == second.mean_radiance);
}

TEST_CASE("what gets next to nothing of the scattered light is nothing") {
  Sensor sensor = scattering_sensor();
  sensor.scatter = {{0.01, 12e-6}};
  Measurement frame;
  frame.resolution = sensor.resolution;
  Return &of = frame.returns.emplace_back();
  const std::size_t pixels = sensor.pixel_count(), bright = 3 * 37 + 3;
  of.amplitude.assign(pixels, 0.0f);
  of.phase_rad.assign(pixels, std::nanf(""));
  of.distance_m.assign(pixels, std::nanf(""));
  frame.mean_radiance.assign(pixels, 0.0f);
  of.amplitude[bright] = frame.mean_radiance[bright] = 1.0f;
  of.phase_rad[bright] = 1.0f;
  scatter(sensor, frame);
  CHECK(of.amplitude[bright + 1] > 1e-4f);
  CHECK(of.phase_rad[bright + 1] == Approx(1.0).margin(1e-3));
  CHECK(of.amplitude[pixels - 1] == 0.0f);
  CHECK(std::isnan(of.phase_rad[pixels - 1]));
  CHECK(std::isnan(of.distance_m[pixels - 1]));
  for (const float mean : frame.mean_radiance)
    CHECK(mean >= 0.0f);
}
