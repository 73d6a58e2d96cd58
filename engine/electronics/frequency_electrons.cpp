#include "engine/electronics/frequency_electrons.h"

#include "engine/electronics/photon_chain.h"
#include "engine/model/float_below.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace pmdsim {
namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;

float as_float(double value) { return static_cast<float>(value); }

// Where no reading of a tap is counted one by one, or beyond what the camera has numbers for: the tap's mean
// light, electrons.
struct ClearLight {
  double from_e, to_e;
};

ClearLight clear_light(const Electronics &of) {
  constexpr double largest = largest_normal, rounding = 1e-5;
  // What is added to a mean beyond its deviation times a normal number: the expansion's other terms, at most
  // 6, read noise below least_merged_noise_e, at most 5.4, and the rounding to whole electrons.
  const double apart_e = 12.0 + largest * of.dsnu_e, variance_e2 = of.read_noise_e * of.read_noise_e;
  // The mean m of which m + side * largest * sqrt(m + variance) is `charge_e`.
  const auto mean_e = [&](double charge_e, double side) {
    const double half = 0.5 * largest, squared = half * half + charge_e + variance_e2;
    const double deviation = std::sqrt(std::max(squared, 0.0)) - side * half;
    return deviation * deviation - variance_e2;
  };
  const double empty_e = -of.offset_dn / of.gain_dn_per_e,
               full_e = std::min(of.full_well_e, (of.largest_dn() - of.offset_dn) / of.gain_dn_per_e);
  const double dimmest_e = std::max(mean_e(empty_e + apart_e, -1.0), double{largest_counted_mean}),
               brightest_e = mean_e(full_e - apart_e, 1.0);
  const double dark_e = 0.5 * of.dark_current_e_per_s * of.integration_time_s, spread = largest * of.prnu;
  if (spread >= 1.0)
    return {std::numeric_limits<double>::infinity(), 0.0};
  // And none has less light than none, which rounding may leave.
  return {std::max((1.0 + rounding) * (dimmest_e - dark_e) / (1.0 - spread), rounding * dark_e),
          (1.0 - rounding) * (brightest_e - dark_e) / (1.0 + spread)};
}

} // namespace

FrequencyElectrons::FrequencyElectrons(const Sensor &sensor, bool keep_taps, std::size_t frequency,
                                       Measurement &frame)
    : sensor_(sensor), electronics_(*sensor.electronics), keep_taps_(keep_taps), frequency_(frequency),
      frame_(frame), to_(frame.returns[frequency]) {
  set_images();
  set_electronics();
  set_camera();
  set_counter();
  set_output();
}

FrequencyElectrons::Phasors FrequencyElectrons::phasors(std::uint32_t images, double multiple) {
  Phasors of{};
  for (std::uint32_t k = 0; k < images; ++k) {
    const double angle_rad = multiple * turn_rad * k / images;
    of[k] = {as_float(std::cos(angle_rad)), as_float(std::sin(angle_rad))};
  }
  return of;
}

void FrequencyElectrons::set_images() {
  work_.images = sensor_.taps;
  work_.of_image = as_float(2.0 / sensor_.taps);
  reference_ = phasors(sensor_.taps, 1.0);
  twice_reference_ = phasors(sensor_.taps, 2.0);
  work_.reference = reinterpret_cast<const float(*)[2]>(reference_.data());
  work_.twice_reference = reinterpret_cast<const float(*)[2]>(twice_reference_.data());
}

void FrequencyElectrons::set_light(const ElectronsRequest &request) {
  const bool one_by_one = !request.mean_radiance_of_taps.empty();
  for (std::uint32_t k = 0; k < sensor_.taps; ++k)
    mean_[k] = one_by_one ? request.mean_radiance_of_taps[frequency_ * sensor_.taps + k].data()
                          : frame_.mean_radiance.data();
  work_.mean_radiance = mean_.data();
  if (frame_.mean_radiance.size() != sensor_.pixel_count())
    throw std::logic_error("electrons of a frame without its mean radiance");
  // Taps that are exposed one by one are no samples of one sine.
  work_.is_sine = sensor_.waveform.kind == Waveform::Kind::sine && !one_by_one && !request.reads_taps;
  if (work_.is_sine) {
    work_.amplitude = to_.amplitude.data();
    work_.phase_rad = to_.phase_rad.data();
  } else {
    if (to_.taps.size() != sensor_.taps)
      throw std::logic_error("electrons of a frame without its taps");
    for (std::uint32_t k = 0; k < sensor_.taps; ++k)
      taps_in_[k] = to_.taps[k].data();
    work_.taps = taps_in_.data();
  }
  set_taps_out();
}

void FrequencyElectrons::set_light(const StripLight &light) {
  work_.is_sine = true;
  work_.complex_returns = light.is_complex;
  work_.return_pairs = light.returns[frequency_];
  work_.mean_pairs = light.mean_radiance;
  work_.mean_radiance_out = frequency_ == 0 ? frame_.mean_radiance.data() : nullptr;
  set_taps_out();
}

void FrequencyElectrons::set_electronics() {
  const double per_radiance = electrons_of(1.0, sensor_), contrast = electronics_.contrast(frequency_);
  work_.half_per_radiance = as_float(0.5 * per_radiance);
  work_.part_per_correlation = as_float(0.5 * contrast * per_radiance);
  work_.all_background_e = as_float(0.5 * electrons_of(electronics_.background_radiance_w_m2_sr, sensor_));
  if (const auto &image = electronics_.background_image; !image.empty()) {
    if (image.size() != sensor_.pixel_count())
      throw std::logic_error("a background of other pixels than the sensor's");
    work_.background = image.data();
  }
  work_.dark_e = as_float(0.5 * electronics_.dark_current_e_per_s * electronics_.integration_time_s);
  work_.read_noise_e = as_float(electronics_.read_noise_e);
  work_.full_well_e = as_float(electronics_.full_well_e);
  work_.sbi_e = as_float(electronics_.sbi_e);
  work_.dsnu_e = as_float(electronics_.dsnu_e);
  work_.prnu = as_float(electronics_.prnu);
  work_.reading_variance_e2 = as_float(reading_variance_e2(electronics_));
  work_.gain_dn_per_e = as_float(electronics_.gain_dn_per_e);
  work_.offset_dn = as_float(electronics_.offset_dn);
  work_.largest_dn = as_float(electronics_.largest_dn());
  work_.two_tap = electronics_.two_tap;
  work_.exposures = electronics_.readings();
  work_.parts = electronics_.parts_averaged;
  work_.per_exposure = as_float(1.0 / electronics_.readings());
  const ClearLight clear = clear_light(electronics_);
  work_.clear_from_e = as_float(clear.from_e);
  work_.clear_to_e = as_float(clear.to_e);
}

void FrequencyElectrons::set_camera() {
  const double per_radiance = electrons_of(1.0, sensor_), contrast = electronics_.contrast(frequency_);
  // One tap has half of the signal that the difference of two has.
  const double radiance_per_e = (electronics_.two_tap ? 1.0 : 2.0) / (contrast * per_radiance);
  const double exposures = electronics_.readings(), ambiguity_m = sensor_.ambiguity_m(frequency_);
  work_.radiance_per_dn = as_float(radiance_per_e / electronics_.gain_dn_per_e);
  work_.confidence_scale = as_float(std::sqrt(2.0 * exposures) / electronics_.gain_dn_per_e);
  work_.noise_scale =
      as_float(ambiguity_m / turn_rad * 2.0 / sensor_.taps * radiance_per_e / std::sqrt(exposures));
  work_.ambiguity_m = as_float(ambiguity_m);
  work_.below_turn = largest_float_below(turn_rad);
  work_.below_m = largest_float_below(ambiguity_m);
}

void FrequencyElectrons::set_counter() {
  work_.key[0] = static_cast<std::uint32_t>(electronics_.seed);
  work_.key[1] = static_cast<std::uint32_t>(electronics_.seed >> 32);
  work_.frame = frame_.number.frame;
  work_.sensor = frame_.number.sensor;
  work_.frequency = static_cast<std::uint32_t>(frequency_);
}

void FrequencyElectrons::set_output() {
  const std::size_t pixels = sensor_.pixel_count();
  if (electronics_.noiseless_channels) {
    to_.amplitude_noiseless = to_.amplitude;
    to_.phase_rad_noiseless = to_.phase_rad;
    to_.distance_m_noiseless = to_.distance_m;
    to_.unrounded_distance_m_noiseless = to_.unrounded_distance_m;
  } else {
    for (auto *channel : {&to_.amplitude_noiseless, &to_.phase_rad_noiseless, &to_.distance_m_noiseless})
      channel->clear();
    to_.unrounded_distance_m_noiseless.clear();
  }
  to_.saturated.resize(pixels);
  for (auto *channel : {&to_.distance_noise_m, &to_.confidence})
    channel->resize(pixels);
  work_.amplitude_out = to_.amplitude.data();
  work_.phase_rad_out = to_.phase_rad.data();
  work_.distance_m_out = to_.distance_m.data();
  work_.distance_noise_m = to_.distance_noise_m.data();
  work_.confidence = to_.confidence.data();
  work_.saturated = to_.saturated.data();
}

void FrequencyElectrons::set_taps_out() {
  const bool keep_b = keep_taps_ && electronics_.two_tap;
  work_.tap_e[0] = room_of_taps(keep_taps_, to_.tap_a_e);
  work_.tap_dn[0] = room_of_taps(keep_taps_, to_.tap_a_dn);
  work_.tap_e[1] = room_of_taps(keep_b, to_.tap_b_e);
  work_.tap_dn[1] = room_of_taps(keep_b, to_.tap_b_dn);
  if (keep_taps_) // else those of the light are there to be read
    work_.taps_out = room_of_taps(true, to_.taps);
}

float *const *FrequencyElectrons::room_of_taps(bool keep, std::vector<std::vector<float>> &channel) {
  channel.resize(keep ? sensor_.taps : 0);
  if (!keep)
    return nullptr;
  std::vector<float *> &pointers = taps_out_.emplace_back();
  for (std::vector<float> &of_tap : channel) {
    of_tap.resize(sensor_.pixel_count());
    pointers.push_back(of_tap.data());
  }
  return pointers.data(); // where it stays as others come
}

} // namespace pmdsim
