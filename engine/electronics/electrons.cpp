#include "engine/electronics/electrons.h"

#include "engine/electronics/electron_work.h"
#include "engine/electronics/photon_chain.h"
#include "engine/model/float_below.h"
#include "engine/model/instruction_sets.h"
#include "engine/model/stopwatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::ElectronLoops, electron_loops)

namespace pmdsim {
namespace {

constexpr double turn_rad = 2.0 * std::numbers::pi;
// Whole blocks of all instruction sets: a thread's work, of one exposure and of many.
constexpr std::uint32_t pixels_at_once = 96 * 48, pixels_of_many = 6 * 48;
constexpr std::uint32_t many_exposures = 64;
// Of each thread, between which a frame of many exposures may be stopped.
constexpr std::uint32_t parts_at_once = 4;

using Pointers = std::array<float *, most_images>;
using Phasors = std::array<std::array<float, 2>, most_images>;

Phasors phasors(std::uint32_t images, double multiple) {
  Phasors of{};
  for (std::uint32_t k = 0; k < images; ++k) {
    const double angle_rad = multiple * turn_rad * k / images;
    of[k] = {static_cast<float>(std::cos(angle_rad)), static_cast<float>(std::sin(angle_rad))};
  }
  return of;
}

// An array of each tap, or none.
void set_taps(bool keep, std::uint32_t images, std::size_t pixels, std::vector<std::vector<float>> &channel,
              Pointers &pointers) {
  channel.resize(keep ? images : 0);
  for (std::size_t k = 0; k < channel.size(); ++k) {
    channel[k].resize(pixels);
    pointers[k] = channel[k].data();
  }
}

// Where no reading of a tap is counted one by one, or beyond what the camera has numbers for: the tap's mean light,
// electrons.
struct ClearLight {
  double from_e, to_e;
};

ClearLight clear_light(const Electronics &of) {
  constexpr double largest = largest_normal, rounding = 1e-5;
  // What is added to a mean beyond its deviation times a normal number: the expansion's other terms, at most 6, and
  // read noise below least_merged_noise_e.
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
  return {(1.0 + rounding) * (dimmest_e - dark_e) / (1.0 - spread),
          (1.0 - rounding) * (brightest_e - dark_e) / (1.0 + spread)};
}

// One frequency of a frame.
class FrequencyElectrons {
public:
  FrequencyElectrons(const Sensor &sensor, const ElectronsRequest &request, std::size_t frequency,
                     Measurement &frame)
      : sensor_(sensor), electronics_(*sensor.electronics), to_(frame.returns[frequency]) {
    set_light(request, frequency, frame);
    set_electronics(frequency);
    set_counter(frequency, frame.number);
    set_output(request.keep_taps, frequency);
  }

  void count(const ElectronLoops &loops, const std::function<void()> &between) const {
    const auto pixels = static_cast<std::uint32_t>(sensor_.pixel_count());
    const bool are_many = work_.exposures > many_exposures;
    const std::uint32_t of_part = are_many ? pixels_of_many : pixels_at_once;
    const std::uint32_t parts = (pixels + of_part - 1) / of_part;
    const auto threads = static_cast<std::uint32_t>(tbb::this_task_arena::max_concurrency());
    const std::uint32_t at_once = are_many ? parts_at_once * threads : parts;
    for (std::uint32_t begin = 0; begin < parts; begin += at_once) {
      tbb::parallel_for(begin, std::min(begin + at_once, parts), [&](std::uint32_t part) {
        const std::uint32_t first = part * of_part;
        loops.count(work_, first, std::min(first + of_part, pixels));
      });
      if (between)
        between();
    }
  }

private:
  void set_light(const ElectronsRequest &request, std::size_t frequency, const Measurement &frame) {
    work_.images = sensor_.taps;
    reference_ = phasors(sensor_.taps, 1.0);
    twice_reference_ = phasors(sensor_.taps, 2.0);
    work_.reference = reinterpret_cast<const float(*)[2]>(reference_.data());
    work_.twice_reference = reinterpret_cast<const float(*)[2]>(twice_reference_.data());
    const bool one_by_one = !request.mean_radiance_of_taps.empty();
    for (std::uint32_t k = 0; k < sensor_.taps; ++k)
      mean_[k] = one_by_one ? request.mean_radiance_of_taps[frequency * sensor_.taps + k].data()
                            : frame.mean_radiance.data();
    work_.mean_radiance = mean_.data();
    if (frame.mean_radiance.size() != sensor_.pixel_count())
      throw std::logic_error("electrons of a frame without its mean radiance");
    // Taps that are exposed one by one are no samples of one sine.
    if (sensor_.waveform.kind == Waveform::Kind::sine && !one_by_one && !request.reads_taps) {
      work_.amplitude = to_.amplitude.data();
      work_.phase_rad = to_.phase_rad.data();
      return;
    }
    if (to_.taps.size() != sensor_.taps)
      throw std::logic_error("electrons of a frame without its taps");
    for (std::uint32_t k = 0; k < sensor_.taps; ++k)
      taps_in_[k] = to_.taps[k].data();
    work_.taps = taps_in_.data();
  }

  void set_electronics(std::size_t frequency) {
    const auto as_float = [](double value) { return static_cast<float>(value); };
    const double per_radiance = electrons_of(1.0, sensor_), contrast = electronics_.contrast(frequency);
    work_.half_per_radiance = as_float(0.5 * per_radiance);
    work_.part_per_correlation = as_float(0.5 * contrast * per_radiance);
    // One tap has half of the signal that the difference of two has.
    const double radiance_per_e = (electronics_.two_tap ? 1.0 : 2.0) / (contrast * per_radiance);
    const double exposures = electronics_.readings(), per_image = 2.0 / sensor_.taps;
    work_.all_background_e = as_float(0.5 * electrons_of(electronics_.background_radiance_w_m2_sr, sensor_));
    if (const std::size_t size = electronics_.background_image.size();
        size > 0 && size != sensor_.pixel_count())
      throw std::logic_error("a background of other pixels than the sensor's");
    for (const float relative : electronics_.background_image)
      background_e_.push_back(relative * work_.all_background_e);
    work_.background_e = background_e_.empty() ? nullptr : background_e_.data();
    work_.dark_e = as_float(0.5 * electronics_.dark_current_e_per_s * electronics_.integration_time_s);
    work_.read_noise_e = as_float(electronics_.read_noise_e);
    work_.full_well_e = as_float(electronics_.full_well_e);
    work_.sbi_e = as_float(electronics_.sbi_e);
    work_.dsnu_e = as_float(electronics_.dsnu_e);
    work_.prnu = as_float(electronics_.prnu);
    work_.reading_variance_e2 = as_float(reading_variance_e2(electronics_));
    work_.gain_dn_per_e = as_float(electronics_.gain_dn_per_e);
    work_.radiance_per_dn = as_float(radiance_per_e / electronics_.gain_dn_per_e);
    work_.confidence_scale = as_float(std::sqrt(2.0 * exposures) / electronics_.gain_dn_per_e);
    const double distance_m_per_rad = sensor_.ambiguity_m(frequency) / turn_rad;
    work_.noise_scale = as_float(distance_m_per_rad * per_image * radiance_per_e / std::sqrt(exposures));
    work_.offset_dn = as_float(electronics_.offset_dn);
    work_.largest_dn = as_float(electronics_.largest_dn());
    work_.two_tap = electronics_.two_tap;
    work_.exposures = electronics_.readings();
    work_.parts = electronics_.parts_averaged;
    work_.per_exposure = as_float(1.0 / exposures);
    work_.of_image = as_float(per_image);
    const ClearLight clear = clear_light(electronics_);
    work_.clear_from_e = as_float(clear.from_e);
    work_.clear_to_e = as_float(clear.to_e);
  }

  void set_counter(std::size_t frequency, const ExposureNumber &number) {
    work_.key[0] = static_cast<std::uint32_t>(electronics_.seed);
    work_.key[1] = static_cast<std::uint32_t>(electronics_.seed >> 32);
    work_.frame = number.frame;
    work_.sensor = number.sensor;
    work_.frequency = static_cast<std::uint32_t>(frequency);
  }

  void set_output(bool keep_taps, std::size_t frequency) {
    const std::size_t pixels = sensor_.pixel_count();
    const double ambiguity_m = sensor_.ambiguity_m(frequency);
    work_.ambiguity_m = static_cast<float>(ambiguity_m);
    work_.below_turn = largest_float_below(turn_rad);
    work_.below_m = largest_float_below(ambiguity_m);
    if (electronics_.noiseless_channels) {
      to_.amplitude_noiseless = to_.amplitude;
      to_.phase_rad_noiseless = to_.phase_rad;
      to_.distance_m_noiseless = to_.distance_m;
    } else {
      for (auto *channel : {&to_.amplitude_noiseless, &to_.phase_rad_noiseless, &to_.distance_m_noiseless})
        channel->clear();
    }
    to_.saturated.resize(pixels);
    to_.distance_noise_m.resize(pixels);
    to_.confidence.resize(pixels);
    work_.amplitude_out = to_.amplitude.data();
    work_.phase_rad_out = to_.phase_rad.data();
    work_.distance_m_out = to_.distance_m.data();
    work_.distance_noise_m = to_.distance_noise_m.data();
    work_.confidence = to_.confidence.data();
    work_.saturated = to_.saturated.data();
    if (keep_taps)
      set_taps(true, sensor_.taps, pixels, to_.taps, taps_out_);
    set_taps(keep_taps, sensor_.taps, pixels, to_.tap_a_e, tap_e_[0]);
    set_taps(keep_taps, sensor_.taps, pixels, to_.tap_a_dn, tap_dn_[0]);
    set_taps(keep_taps && electronics_.two_tap, sensor_.taps, pixels, to_.tap_b_e, tap_e_[1]);
    set_taps(keep_taps && electronics_.two_tap, sensor_.taps, pixels, to_.tap_b_dn, tap_dn_[1]);
    if (!keep_taps)
      return;
    work_.taps_out = taps_out_.data();
    for (const std::size_t tap : {std::size_t{0}, std::size_t{1}})
      if (tap == 0 || electronics_.two_tap) {
        work_.tap_e[tap] = tap_e_[tap].data();
        work_.tap_dn[tap] = tap_dn_[tap].data();
      }
  }

  const Sensor &sensor_;
  const Electronics &electronics_;
  Return &to_;
  Phasors reference_{}, twice_reference_{};
  std::array<const float *, most_images> mean_{}, taps_in_{};
  std::vector<float> background_e_;
  Pointers taps_out_{};
  std::array<Pointers, 2> tap_e_{}, tap_dn_{};
  ElectronWork work_{};
};

} // namespace

void count_electrons(const Sensor &sensor, const ElectronsRequest &request, Measurement &frame) {
  Stopwatch stopwatch;
  const ElectronLoops &loops = widest_electron_loops(request.host_vector_bits);
  for (std::size_t i = 0; i < frame.returns.size(); ++i) {
    FrequencyElectrons(sensor, request, i, frame).count(loops, request.between);
    if (!request.keep_taps)
      frame.returns[i].taps.clear();
  }
  stopwatch.add_to(frame, "electrons");
}

} // namespace pmdsim
