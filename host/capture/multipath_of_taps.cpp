#include "host/capture/multipath_of_taps.h"

#include "engine/model/tap_sequence.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <utility>

namespace pmdsim {
namespace {

constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

// Where only one has a value, that.
void raise_to(std::vector<float> &largest, const std::vector<float> &values) {
  largest.resize(values.size(), no_value);
  for (std::size_t pixel = 0; pixel < values.size(); ++pixel)
    largest[pixel] = std::fmax(largest[pixel], values[pixel]);
}

std::complex<double> z_of(float amplitude, float phase_rad) {
  return amplitude > 0.0f ? std::polar(static_cast<double>(amplitude), static_cast<double>(phase_rad)) : 0.0;
}

// To (-period/2, period/2].
double wrapped(double value, double period) { return value - period * std::ceil(value / period - 0.5); }

std::vector<float> multipath_m(const Return &whole, const Return &direct, double ambiguity_m) {
  std::vector<float> added_m;
  for (std::size_t pixel = 0; pixel < whole.distance_m.size(); ++pixel)
    added_m.push_back(static_cast<float>(
        wrapped(whole.unrounded_distance_m[pixel] - direct.unrounded_distance_m[pixel], ambiguity_m)));
  return added_m;
}

std::vector<float> indirect_share(const Return &whole, const Return &direct) {
  std::vector<float> share;
  for (std::size_t pixel = 0; pixel < whole.amplitude.size(); ++pixel) {
    const std::complex<double> z = z_of(whole.amplitude[pixel], whole.phase_rad[pixel]);
    const std::complex<double> z_direct = z_of(direct.amplitude[pixel], direct.phase_rad[pixel]);
    share.push_back(z == 0.0 ? no_value : static_cast<float>(std::abs(z - z_direct) / std::abs(z)));
  }
  return share;
}

} // namespace

void BouncesOfTaps::add(const Measurement &exposure, std::size_t frequency, std::size_t tap) {
  if (!exposure.bounces)
    return;
  const bool is_sine = sensor_.waveform.kind == Waveform::Kind::sine;
  if (!report_)
    report_ = BouncesReport{.claimed_m = std::numeric_limits<double>::quiet_NaN()};
  report_->elements = std::max(report_->elements, exposure.bounces->elements);
  report_->lines += exposure.bounces->lines;
  report_->products += exposure.bounces->products;
  if (!is_sine)
    return;
  if (frequency == 0)
    report_->claimed_m = std::fmax(report_->claimed_m, exposure.bounces->claimed_m);
  const Return &returned = exposure.returns.front();
  const double reference_rad = 2.0 * std::numbers::pi * static_cast<double>(tap) / sensor_.taps;
  direct_taps_.push_back(tap_of_sine(returned.direct_amplitude, returned.direct_phase_rad, reference_rad));
  raise_to(error_m_, returned.multipath_error_m);
}

void BouncesOfTaps::finish(Return &of_frequency, std::size_t frequency) {
  std::vector<float> error_m = std::exchange(error_m_, {});
  if (direct_taps_.empty())
    return;
  Return direct = return_from_taps(std::exchange(direct_taps_, {}), sensor_.modulation_hz[frequency], true);
  for (std::size_t pixel = 0; pixel < error_m.size(); ++pixel)
    if (std::isnan(of_frequency.distance_m[pixel]))
      error_m[pixel] = no_value;
  of_frequency.multipath_m = multipath_m(of_frequency, direct, sensor_.ambiguity_m(frequency));
  of_frequency.multipath_error_m = std::move(error_m);
  of_frequency.indirect_share = indirect_share(of_frequency, direct);
  of_frequency.direct_amplitude = std::move(direct.amplitude);
  of_frequency.direct_phase_rad = std::move(direct.phase_rad);
  of_frequency.direct_distance_m = std::move(direct.distance_m);
  of_frequency.unrounded_direct_distance_m = std::move(direct.unrounded_distance_m);
}

} // namespace pmdsim
