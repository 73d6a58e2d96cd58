// A pixel's electrons, from the mean light to what the camera makes of its digital numbers (docs/theory.md,
// "Electrons"), in blocks of pixels.

#include "engine/electronics/tap_charge.h"

#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float two_pi_float = 6.2831853f;

// What the camera reads of an image: taps' electrons before the ADC, and digital numbers.
struct Reading {
  FloatBlock charge_e[2], number_dn[2];
};

// Takes from both taps alike what would not fit into the fuller one's well.
PMDSIM_INLINED void suppress_background(const ElectronWork &of, Reading &reading) {
  const FloatBlock none = filled(0.0f);
  const FloatBlock over = larger(larger(reading.charge_e[0], reading.charge_e[1]) - of.full_well_e, none);
  const FloatBlock common = larger(smaller(reading.charge_e[0], reading.charge_e[1]), none);
  const FloatBlock taken = smaller(smaller(over, filled(of.sbi_e)), common);
  reading.charge_e[0] -= taken;
  reading.charge_e[1] -= taken;
}

PMDSIM_INLINED FloatBlock voltage_dn(const ElectronWork &of, const FloatBlock &charge_e) {
  return fused(filled(of.gain_dn_per_e), charge_e, of.offset_dn);
}

// The lanes where the tap is full, or beyond the ADC's range.
PMDSIM_INLINED IntBlock read_tap(const ElectronWork &of, Reading &reading, std::uint32_t tap) {
  FloatBlock &charge = reading.charge_e[tap];
  const IntBlock is_full = charge > of.full_well_e;
  charge = smaller(charge, filled(of.full_well_e));
  const FloatBlock voltage = voltage_dn(of, charge);
  reading.number_dn[tap] = rounded(smaller(larger(voltage, filled(0.0f)), filled(of.largest_dn)));
  return is_full | (voltage > of.largest_dn + 0.5f);
}

// The angle of z in turns, in [0, 1], to 1e-7: more than noise leaves of it. Twice as fast as angle_turns().
PMDSIM_INLINED FloatBlock phase_turns(const ComplexBlock &z) {
  const FloatBlock x = absolute(z.re), y = absolute(z.im), t = smaller(x, y) / larger(x, y), u = t * t;
  FloatBlock p = fused(0.00125149532f, u, -0.00589080225f);
  constexpr float coefficients[] = {0.0133485148f, -0.0214655319f, 0.0316423621f, -0.0530407959f,
                                    0.159154839f};
  for (const float coefficient : coefficients)
    p = fused(p, u, coefficient);
  FloatBlock angle = p * t;
  angle = chosen(y > x, 0.25f - angle, angle);
  angle = chosen(z.re < 0.0f, 0.5f - angle, angle);
  return chosen(z.im < 0.0f, 1.0f - angle, angle);
}

// A sum of many readings is as exact as one of few: W. Kahan, "Further remarks on reducing truncation
// errors", CACM 8 (1965).
PMDSIM_INLINED void add_exactly(FloatBlock &sum, FloatBlock &rest, const FloatBlock &term) {
  const FloatBlock whole = sum + term;
  rest += term - (whole - sum);
  sum = whole;
}

// A block of pixels. `clear`: all of them there, of one exposure, and neither dark nor near the ends of what
// the camera reads. Then little is kept in memory, as with AVX2 and AVX-512 nothing is called.
template <bool two_tap, bool merged, bool clear>
class PixelElectrons {
public:
  PMDSIM_INLINED PixelElectrons(const ElectronWork &of, const Pixels<clear> &pixels)
      : of_(of), pixels_(pixels) {
    if constexpr (!clear)
      for (std::uint32_t k = 0; k < of_.images; ++k)
        readings_[k] = rests_[k] = {};
    find_light();
  }

  // With a normal number of each tap, and where shot noise and read noise are apart one more of each.
  PMDSIM_INLINED void expose(std::uint32_t exposure, const Draws &counts, const Draws &reads) {
    if (of_.dsnu_e == 0.0f && of_.prnu == 0.0f) {
      for (std::uint32_t image = 0; image < of_.images; ++image)
        expose_image<false>(exposure, image, counts, reads);
      return;
    }
    if (exposure == 0 || of_.parts > 1)
      pattern_ = fixed_pattern(of_, pixels_.numbers(), exposure % of_.parts);
    for (std::uint32_t image = 0; image < of_.images; ++image)
      expose_image<true>(exposure, image, counts, reads);
  }

  PMDSIM_INLINED void store() {
    if constexpr (!clear)
      for (std::uint32_t image = 0; image < of_.images; ++image)
        demodulate(image, mean_reading(image));
    store_return();
    store_noise();
    pixels_.store_to(of_.saturated, saturated_);
    if (!two_tap && of_.taps_out)
      take_common_off();
  }

private:
  static constexpr std::uint32_t taps_ = two_tap ? 2 : 1;

  bool is_sine() const { return clear || of_.is_sine; }

  // What a tap has of the noiseless z, electrons.
  PMDSIM_INLINED void find_light() {
    if (is_sine()) {
      const SineLight light = sine_light(of_, pixels_);
      if (of_.mean_radiance_out)
        pixels_.store_to(of_.mean_radiance_out, light.mean_radiance);
      common_e_ = common_light(of_, pixels_, light.mean_radiance);
      amplitude_ = light.amplitude;
      z_e_ = {of_.part_per_correlation * light.z.re, of_.part_per_correlation * light.z.im};
      return;
    }
    for (std::uint32_t k = 0; k < of_.images; ++k) {
      z_e_.re += (of_.of_image * of_.reference[k][0]) * part_e(k);
      z_e_.im += (of_.of_image * of_.reference[k][1]) * part_e(k);
    }
    amplitude_ = magnitude_of_any(z_e_) / of_.part_per_correlation;
  }

  // What the image's correlation sample adds to tap A and takes from B.
  PMDSIM_INLINED FloatBlock part_e(std::uint32_t image) const {
    if (is_sine())
      return fused(filled(of_.reference[image][0]), z_e_.re, of_.reference[image][1] * z_e_.im);
    return of_.part_per_correlation * pixels_.load_from(of_.taps[image]);
  }

  template <bool patterned>
  PMDSIM_INLINED void expose_image(std::uint32_t exposure, std::uint32_t image, const Draws &counts,
                                   const Draws &reads) {
    const FloatBlock part = part_e(image);
    if (!is_sine())
      common_e_ = common_light(of_, pixels_, pixels_.load_from(of_.mean_radiance[image]));
    const FloatBlock lights[2] = {common_e_ + part, common_e_ - part}, dark = filled(of_.dark_e),
                     with_dark = common_e_ + of_.dark_e;
    // The taps' means but for the fixed pattern.
    FloatBlock means[2] = {with_dark + part, with_dark - part};
    if constexpr (!clear) {
      for (FloatBlock &mean : means)
        mean = larger(mean, dark);
      if (exposure == 0)
        predict(image, means);
    }
    Reading reading; // of taps_ taps: to make the other one nothing takes time
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      const std::uint32_t draw = taps_ * image + tap;
      if constexpr (patterned)
        means[tap] = fused(pattern_.response[tap], larger(lights[tap], filled(0.0f)), dark);
      reading.charge_e[tap] = charge(exposure, draw, means[tap], counts.of[draw], reads.of[draw]);
      if constexpr (patterned)
        reading.charge_e[tap] += pattern_.offset_e[tap];
    }
    read(image, reading);
  }

  // Whether the image's taps are to be full; of light that is no sine, the variance of its reading, too.
  PMDSIM_INLINED void predict(std::uint32_t image, const FloatBlock (&means)[2]) {
    FloatBlock fullest = two_tap ? larger(means[0], means[1]) : means[0];
    if (two_tap && of_.sbi_e > 0.0f) {
      const FloatBlock over = larger(fullest - of_.full_well_e, filled(0.0f));
      fullest -= smaller(over, smaller(filled(of_.sbi_e), smaller(means[0], means[1])));
    }
    fullest_ = larger(fullest_, fullest);
    if (is_sine())
      return;
    const FloatBlock variance = (two_tap ? means[0] + means[1] : means[0]) + taps_ * of_.reading_variance_e2;
    variance_ += variance;
    second_.re += of_.twice_reference[image][0] * variance;
    second_.im += of_.twice_reference[image][1] * variance;
  }

  // The electrons of a tap of that mean, with its read noise. `merged`: both are drawn as one.
  PMDSIM_INLINED FloatBlock charge(std::uint32_t exposure, std::uint32_t draw, const FloatBlock &mean,
                                   const FloatBlock &count, const FloatBlock &read) {
    FloatBlock charge;
    if constexpr (merged) {
      charge = merged_charge(mean, of_.read_noise_e * of_.read_noise_e, count);
    } else {
      charge = whole_count(merged_charge(larger(mean, filled(1.0f)), 0.0f, count));
      if (of_.read_noise_e > 0.0f)
        charge += of_.read_noise_e * read;
    }
    if constexpr (!clear)
      if (is_any_below(mean, largest_counted_mean))
        return counted_charge(of_, pixels_.numbers(), exposure, draw, mean, count, charge);
    return charge;
  }

  PMDSIM_INLINED void read(std::uint32_t image, Reading &reading) {
    if constexpr (clear) {
      for (std::uint32_t tap = 0; tap < taps_; ++tap)
        reading.number_dn[tap] = rounded(voltage_dn(of_, reading.charge_e[tap]));
      demodulate(image, reading);
    } else {
      if (two_tap && of_.sbi_e > 0.0f)
        suppress_background(of_, reading);
      for (std::uint32_t tap = 0; tap < taps_; ++tap) {
        const IntBlock is_full = read_tap(of_, reading, tap);
        saturated_ |= is_full & static_cast<std::int32_t>(1u << (16 * tap + image));
        add_exactly(readings_[image].charge_e[tap], rests_[image].charge_e[tap], reading.charge_e[tap]);
        add_exactly(readings_[image].number_dn[tap], rests_[image].number_dn[tap], reading.number_dn[tap]);
      }
    }
  }

  // Of all exposures.
  PMDSIM_INLINED Reading mean_reading(std::uint32_t image) const {
    Reading mean = readings_[image];
    for (std::uint32_t tap = 0; of_.exposures > 1 && tap < taps_; ++tap) {
      mean.charge_e[tap] = of_.per_exposure * (mean.charge_e[tap] + rests_[image].charge_e[tap]);
      mean.number_dn[tap] = of_.per_exposure * (mean.number_dn[tap] + rests_[image].number_dn[tap]);
    }
    return mean;
  }

  PMDSIM_INLINED void demodulate(std::uint32_t image, const Reading &reading) {
    // What the camera takes for the image's correlation sample; of one tap with all that is common.
    const FloatBlock difference_dn =
        reading.number_dn[0] - (two_tap ? reading.number_dn[1] : filled(of_.offset_dn));
    largest_dn_ = larger(largest_dn_, absolute(difference_dn));
    read_dn_ = {fused(of_.reference[image][0], difference_dn, read_dn_.re),
                fused(of_.reference[image][1], difference_dn, read_dn_.im)};
    if (!of_.taps_out)
      return;
    pixels_.store_to(of_.taps_out[image], of_.radiance_per_dn * difference_dn);
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      pixels_.store_to(of_.tap_e[tap][image], reading.charge_e[tap]);
      pixels_.store_to(of_.tap_dn[tap][image], reading.number_dn[tap]);
    }
  }

  PMDSIM_INLINED void store_return() {
    // Less than that is rounding: all numbers are alike.
    const FloatBlock least_dn = (0x1p-21f * static_cast<float>(of_.images)) * largest_dn_;
    const IntBlock is_known = (absolute(read_dn_.re) > least_dn) | (absolute(read_dn_.im) > least_dn);
    size_dn_ = chosen(is_known, magnitude(read_dn_), filled(0.0f));
    const FloatBlock turns = phase_turns(read_dn_), nan = filled(not_a_number);
    pixels_.store_to(of_.amplitude_out, (of_.radiance_per_dn * of_.of_image) * size_dn_);
    pixels_.store_to(of_.phase_rad_out,
                     chosen(is_known, smaller(two_pi_float * turns, filled(of_.below_turn)), nan));
    pixels_.store_to(of_.distance_m_out,
                     chosen(is_known, smaller(of_.ambiguity_m * turns, filled(of_.below_m)), nan));
  }

  // sigma_phi^2 = (2 / (N a))^2 sum_k variance_k sin^2(phi - theta_k), a the amplitude in electrons.
  PMDSIM_INLINED void store_noise() {
    if (is_sine())
      variance_ =
          static_cast<float>(taps_ * of_.images) * (common_e_ + (of_.dark_e + of_.reading_variance_e2));
    const FloatBlock deviation = exact_root(variance_);
    pixels_.store_to(of_.confidence, of_.confidence_scale * size_dn_ / deviation);
    constexpr float root_of_half = 0.70710678f;
    const FloatBlock across = two_tap && is_sine()
                                  ? root_of_half * deviation
                                  : exact_root(larger(filled(0.0f), 0.5f * (variance_ - along())));
    IntBlock is_known = amplitude_ > 0.0f;
    if constexpr (!clear) {
      const FloatBlock fullest_dn = voltage_dn(of_, fullest_);
      is_known = is_known & ~((fullest_ > of_.full_well_e) | (fullest_dn > of_.largest_dn));
    }
    pixels_.store_to(of_.distance_noise_m,
                     chosen(is_known, of_.noise_scale * across / amplitude_, filled(not_a_number)));
  }

  // sum_k variance_k cos(2 (phi - theta_k)). Of a sine that is read by one tap: of three images alone any is
  // left.
  PMDSIM_INLINED FloatBlock along() const {
    if (is_sine() && of_.images != 3)
      return filled(0.0f);
    const FloatBlock size_e = of_.part_per_correlation * amplitude_, cos = z_e_.re / size_e,
                     sin = z_e_.im / size_e;
    if (is_sine())
      return 1.5f * size_e * cos * (4.0f * cos * cos - 3.0f);
    return second_.re * (cos * cos - sin * sin) + second_.im * (2.0f * cos * sin);
  }

  // Of one tap the mean of all images is none of the correlation samples'.
  PMDSIM_INLINED void take_common_off() {
    FloatBlock mean{};
    for (std::uint32_t image = 0; image < of_.images; ++image)
      mean += (0.5f * of_.of_image) * pixels_.load_from(of_.taps_out[image]);
    for (std::uint32_t image = 0; image < of_.images; ++image)
      pixels_.store_to(of_.taps_out[image], pixels_.load_from(of_.taps_out[image]) - mean);
  }

  const ElectronWork &of_;
  const Pixels<clear> pixels_;
  FixedPattern pattern_;
  ComplexBlock z_e_{};
  FloatBlock amplitude_, common_e_;
  FloatBlock variance_{}; // sum over the images
  ComplexBlock second_{}; // the same times exp(2 j theta_k)
  FloatBlock fullest_{};  // charge of all taps, in the mean
  IntBlock saturated_{};
  // Sums over the exposures, and what rounding took from them.
  Reading readings_[clear ? 1 : most_images], rests_[clear ? 1 : most_images];
  ComplexBlock read_dn_{};            // N/2 times what the camera makes of its numbers
  FloatBlock largest_dn_{}, size_dn_; // of the differences the largest, and of read_dn_
};

// Whether all of a block's pixels are clear; no where that is close. `rounding` is more than the errors of
// the taps' means, relative to their terms.
PMDSIM_INLINED bool is_clear(const ElectronWork &of, const Pixels<true> &pixels) {
  constexpr float rounding = 1e-6f;
  const SineLight light = sine_light(of, pixels);
  const FloatBlock common = common_light(of, pixels, light.mean_radiance),
                   part = of.part_per_correlation * light.amplitude;
  const FloatBlock darkest = (1.0f - rounding) * common - (1.0f + rounding) * part,
                   brightest = (1.0f + rounding) * (common + part);
  return are_all_above(darkest, of.clear_from_e) && are_all_above(of.clear_to_e - brightest, 0.0f);
}

template <bool two_tap, bool merged, bool clear>
[[gnu::noinline]] void count_block(const ElectronWork &of, const Pixels<clear> &pixels) {
  const std::uint32_t draws = of.images * (two_tap ? 2 : 1);
  PixelElectrons<two_tap, merged, clear> electrons(of, pixels);
  Draws counts, reads;
  for (std::uint32_t exposure = 0; exposure < (clear ? 1 : of.exposures); ++exposure) {
    draw_normals(of, pixels.numbers(), ChanceStream::normals, exposure, draws, counts);
    if (!merged && of.read_noise_e > 0.0f)
      draw_normals(of, pixels.numbers(), ChanceStream::reads, exposure, draws, reads);
    electrons.expose(exposure, counts, reads);
  }
  electrons.store();
}

template <bool whole>
bool has_finite_light(const ElectronWork &of, const Pixels<whole> &pixels) {
  constexpr float largest = std::numeric_limits<float>::max();
  if (!of.is_sine)
    return true; // whoever has it on the host has looked at it
  const SineLight light = sine_light(of, pixels);
  return !is_any_above(light.amplitude, largest) && !is_any_above(absolute(light.z.re), largest) &&
         !is_any_above(absolute(light.z.im), largest) && !is_any_above(light.mean_radiance, largest);
}

template <bool two_tap, bool merged>
bool count_blocks(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  const bool may_be_clear = of.exposures == 1 && of.is_sine;
  bool are_finite = true;
  for (std::uint32_t pixel = first; pixel < last; pixel += block_lanes) {
    const std::uint32_t left = last - pixel;
    if (may_be_clear && left >= block_lanes && is_clear(of, {pixel})) {
      count_block<two_tap, merged, true>(of, {pixel});
      continue;
    }
    const Pixels<false> pixels{pixel, left < block_lanes ? static_cast<int>(left) : block_lanes};
    are_finite = are_finite && has_finite_light(of, pixels);
    count_block<two_tap, merged, false>(of, pixels);
  }
  return are_finite;
}

bool count_electrons(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  const bool merged = of.read_noise_e >= least_merged_noise_e;
  if (of.two_tap)
    return merged ? count_blocks<true, true>(of, first, last) : count_blocks<true, false>(of, first, last);
  return merged ? count_blocks<false, true>(of, first, last) : count_blocks<false, false>(of, first, last);
}

} // namespace

extern const ElectronLoops electron_loops;
const ElectronLoops electron_loops{count_electrons};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
