#include "engine/model/tap_sequence.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

constexpr double full_turn_rad = 2.0 * std::numbers::pi;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr double tap_rounding = 0x1p-22; // of the largest tap, in all N of them together

// (2/N) exp(+j 2 pi k / N), k = 0 ... N-1.
std::vector<std::complex<double>> weights_of(std::size_t taps) {
  const auto n = static_cast<double>(taps);
  std::vector<std::complex<double>> weights;
  for (std::size_t k = 0; k < taps; ++k)
    weights.push_back(std::polar(2.0 / n, full_turn_rad * static_cast<double>(k) / n));
  return weights;
}

std::complex<double> z_of_pixel(const std::vector<std::vector<float>> &taps,
                                const std::vector<std::complex<double>> &weights, std::size_t pixel) {
  std::complex<double> z = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < taps.size(); ++k) {
    const auto tap = static_cast<double>(taps[k][pixel]);
    z += tap * weights[k];
    largest = std::max(largest, std::abs(tap));
  }
  return std::abs(z) > tap_rounding * largest ? z : 0.0;
}

// Rounding can lift a value just below the end of its range to the end itself, which is the same as zero.
float rounded_below(double value, double end) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) >= end ? 0.0f : rounded;
}

} // namespace

void set_return(Return &to, std::size_t pixel, const std::complex<double> &z, double ambiguity_m) {
  const double angle_rad = std::arg(z);
  const double phase_rad = angle_rad < 0.0 ? angle_rad + full_turn_rad : angle_rad;
  to.amplitude[pixel] = static_cast<float>(std::abs(z));
  to.phase_rad[pixel] = rounded_below(phase_rad, full_turn_rad);
  const double distance_m = ambiguity_m * (phase_rad / full_turn_rad);
  to.distance_m[pixel] = rounded_below(distance_m, ambiguity_m);
  if (!to.unrounded_distance_m.empty())
    to.unrounded_distance_m[pixel] = distance_m < ambiguity_m ? distance_m : 0.0;
}

std::vector<float> tap_of_sine(const std::vector<float> &amplitude, const std::vector<float> &phase_rad,
                               double reference_rad) {
  std::vector<float> tap;
  tap.reserve(amplitude.size());
  for (std::size_t pixel = 0; pixel < amplitude.size(); ++pixel) {
    const auto a = static_cast<double>(amplitude[pixel]), phi = static_cast<double>(phase_rad[pixel]);
    tap.push_back(a > 0.0 ? static_cast<float>(a * std::cos(phi - reference_rad)) : 0.0f);
  }
  return tap;
}

Return return_from_taps(std::vector<std::vector<float>> taps, double modulation_hz, bool keep_unrounded) {
  const double ambiguity_m = speed_of_light_m_s / (2.0 * modulation_hz);
  const std::vector<std::complex<double>> weights = weights_of(taps.size());
  const std::size_t pixels = taps.front().size();
  Return result{std::vector<float>(pixels, 0.0f),
                std::vector<float>(pixels, not_a_number),
                std::vector<float>(pixels, not_a_number),
                {}};
  if (keep_unrounded)
    result.unrounded_distance_m.assign(pixels, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const std::complex<double> z = z_of_pixel(taps, weights, pixel);
    if (z != 0.0)
      set_return(result, pixel, z, ambiguity_m);
  }
  result.taps = std::move(taps);
  return result;
}

void set_from_taps(Return &to, std::vector<std::vector<float>> taps, double modulation_hz) {
  Return set = return_from_taps(std::move(taps), modulation_hz, !to.unrounded_distance_m.empty());
  to.amplitude = std::move(set.amplitude);
  to.phase_rad = std::move(set.phase_rad);
  to.distance_m = std::move(set.distance_m);
  to.unrounded_distance_m = std::move(set.unrounded_distance_m);
  to.taps = std::move(set.taps);
}

} // namespace pmdsim
