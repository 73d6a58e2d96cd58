// A pixel's electrons, from the mean light to what the camera makes of its digital numbers (docs/theory.md,
// "Electrons"), in blocks of pixels.

#include "engine/electronics/tap_charge.h"

#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr float two_pi_float = 6.2831853f, turns_per_rad = 0.15915494f;

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

// The lanes where the tap is full, or beyond the ADC's range.
PMDSIM_INLINED IntBlock read_tap(const ElectronWork &of, Reading &reading, std::uint32_t tap) {
  FloatBlock &charge = reading.charge_e[tap];
  const IntBlock is_full = charge > of.full_well_e;
  charge = smaller(charge, filled(of.full_well_e));
  const FloatBlock voltage_dn = fused(filled(of.gain_dn_per_e), charge, of.offset_dn);
  reading.number_dn[tap] = rounded(smaller(larger(voltage_dn, filled(0.0f)), filled(of.largest_dn)));
  return is_full | (voltage_dn > of.largest_dn + 0.5f);
}

// The angle of z in turns, in [0, 1), to 1e-7: more than noise leaves of it. Twice as fast as angle_turns().
PMDSIM_INLINED FloatBlock phase_turns(const ComplexBlock &z) {
  const FloatBlock x = absolute(z.re), y = absolute(z.im), longer = larger(x, y), shorter = smaller(x, y);
  const IntBlock near_diagonal = shorter > 0.41421356f * longer;
  const FloatBlock t =
      chosen(near_diagonal, shorter - longer, shorter) / chosen(near_diagonal, shorter + longer, longer);
  const FloatBlock u = t * t;
  FloatBlock angle = fused(-0.009591162656f, u, 0.01682240502f);
  constexpr float coefficients[] = {-0.02266292012f, 0.03182809684f, -0.05305160562f, 0.159154943f};
  for (const float coefficient : coefficients)
    angle = fused(angle, u, coefficient);
  angle = fused(angle, t, chosen(near_diagonal, filled(0.125f), filled(0.0f)));
  angle = chosen(y > x, 0.25f - angle, angle);
  angle = chosen(z.re < 0.0f, 0.5f - angle, angle);
  const FloatBlock turns = chosen(z.im < 0.0f, 1.0f - angle, angle);
  return chosen(turns < 1.0f, turns, filled(0.0f));
}

// A sum of many readings is as exact as one of few: W. Kahan, "Further remarks on reducing truncation
// errors", CACM 8 (1965).
PMDSIM_INLINED void add_exactly(FloatBlock &sum, FloatBlock &rest, const FloatBlock &term) {
  const FloatBlock whole = sum + term;
  rest += term - (whole - sum);
  sum = whole;
}

// A block of pixels. `usual`: all of them there, of one exposure, and none of them dark. Then little is
// kept in memory, as with AVX2 and AVX-512 nothing is called.
template <bool two_tap, bool merged, bool usual>
class PixelElectrons {
public:
  PMDSIM_INLINED PixelElectrons(const ElectronWork &of, const Pixels<usual> &pixels)
      : of_(of), pixels_(pixels) {
    find_pattern(0);
    if constexpr (!usual)
      for (std::uint32_t k = 0; k < of_.images; ++k)
        readings_[k] = rests_[k] = {};
  }

  PMDSIM_INLINED void count() {
    find_light();
    for (std::uint32_t exposure = 0; exposure < exposures(); ++exposure) {
      if (!usual && of_.parts > 1)
        find_pattern(exposure % of_.parts);
      for (std::uint32_t image = 0; image < of_.images; ++image)
        expose(exposure, image);
    }
    if constexpr (!usual)
      for (std::uint32_t image = 0; image < of_.images; ++image)
        demodulate(image, mean_reading(image));
    store_return();
    store_noise();
  }

private:
  std::uint32_t exposures() const { return usual ? 1 : of_.exposures; }

  bool has_pattern() const { return of_.dsnu_e > 0.0f || of_.prnu > 0.0f; }
  PMDSIM_INLINED void find_pattern(std::uint32_t part) {
    if (has_pattern())
      pattern_ = fixed_pattern(of_, pixels_.numbers(), part);
  }

  // The noiseless z.
  PMDSIM_INLINED void find_light() {
    if (of_.amplitude) {
      const FloatBlock amplitude = pixels_.load_from(of_.amplitude),
                       phase_rad = pixels_.load_from(of_.phase_rad);
      FloatBlock turns = turns_per_rad * chosen(amplitude > 0.0f, phase_rad, filled(0.0f));
      turns -= chosen(turns > 0.5f, filled(1.0f), filled(0.0f));
      const ComplexBlock phasor = unit_phasor(turns);
      z_ = {amplitude * phasor.re, amplitude * phasor.im};
      return;
    }
    for (std::uint32_t k = 0; k < of_.images; ++k) {
      const FloatBlock light = correlation(k);
      z_.re += (of_.of_image * of_.reference[k][0]) * light;
      z_.im += (of_.of_image * of_.reference[k][1]) * light;
    }
  }

  PMDSIM_INLINED FloatBlock correlation(std::uint32_t image) const {
    if (!of_.amplitude)
      return pixels_.load_from(of_.taps[image]);
    return of_.reference[image][0] * z_.re + of_.reference[image][1] * z_.im;
  }

  PMDSIM_INLINED void expose(std::uint32_t exposure, std::uint32_t image) {
    const TapMeans means = tap_means(of_, pixels_, image, correlation(image));
    if (exposure == 0)
      predict(image, means);
    const std::uint32_t first_draw = taps_ * image;
    if (first_draw % 4 == 0)
      draw(exposure, first_draw / 4);
    Reading reading; // of taps_ taps: to make the other one nothing takes time
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      FloatBlock mean = means.of(tap);
      if (has_pattern())
        mean = fused(pattern_.response[tap], means.light[tap], filled(means.dark_e));
      reading.charge_e[tap] = charge(exposure, first_draw + tap, mean);
      if (has_pattern())
        reading.charge_e[tap] += pattern_.offset_e[tap];
    }
    read(image, reading);
  }

  PMDSIM_INLINED void draw(std::uint32_t exposure, std::uint32_t call) {
    normals_ = normals_of(of_, pixels_.numbers(), ChanceStream::normals, exposure, call);
    if (!merged && of_.read_noise_e > 0.0f)
      reads_ = normals_of(of_, pixels_.numbers(), ChanceStream::reads, exposure, call);
  }

  // The variance of the image's reading, and whether its taps are to be full.
  PMDSIM_INLINED void predict(std::uint32_t image, const TapMeans &means) {
    FloatBlock variance = filled(0.0f), fullest = means.of(0);
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      variance += means.of(tap) + of_.reading_variance_e2;
      fullest = larger(fullest, means.of(tap));
    }
    if (taps_ == 2 && of_.sbi_e > 0.0f) {
      const FloatBlock over = larger(fullest - of_.full_well_e, filled(0.0f));
      fullest -= smaller(over, smaller(filled(of_.sbi_e), smaller(means.of(0), means.of(1))));
    }
    fullest_ = larger(fullest_, fullest);
    variance_ += variance;
    second_.re += of_.twice_reference[image][0] * variance;
    second_.im += of_.twice_reference[image][1] * variance;
  }

  // The electrons of a tap of that mean, with its read noise. `merged`: both are drawn as one.
  PMDSIM_INLINED FloatBlock charge(std::uint32_t exposure, std::uint32_t draw, const FloatBlock &mean) {
    const FloatBlock &z = normals_.of[draw % 4];
    FloatBlock charge;
    if constexpr (merged) {
      charge = merged_charge(mean, of_.read_noise_e * of_.read_noise_e, z);
    } else {
      charge = whole_count(merged_charge(larger(mean, filled(1.0f)), 0.0f, z));
      if (of_.read_noise_e > 0.0f)
        charge += of_.read_noise_e * reads_.of[draw % 4];
    }
    if constexpr (!usual)
      if (is_any_below(mean, largest_counted_mean))
        return counted_charge(of_, pixels_.numbers(), exposure, draw, mean, z, charge);
    return charge;
  }

  PMDSIM_INLINED void read(std::uint32_t image, Reading &reading) {
    if (two_tap && of_.sbi_e > 0.0f)
      suppress_background(of_, reading);
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      const IntBlock is_full = read_tap(of_, reading, tap);
      saturated_ |= is_full & static_cast<std::int32_t>(1u << (16 * tap + image));
    }
    if constexpr (usual)
      demodulate(image, reading);
    else
      keep(image, reading);
  }

  PMDSIM_INLINED void keep(std::uint32_t image, const Reading &reading) {
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      add_exactly(readings_[image].charge_e[tap], rests_[image].charge_e[tap], reading.charge_e[tap]);
      add_exactly(readings_[image].number_dn[tap], rests_[image].number_dn[tap], reading.number_dn[tap]);
    }
  }

  // Of all exposures.
  PMDSIM_INLINED Reading mean_reading(std::uint32_t image) const {
    Reading mean = readings_[image];
    for (std::uint32_t tap = 0; exposures() > 1 && tap < taps_; ++tap) {
      mean.charge_e[tap] = of_.per_exposure * (mean.charge_e[tap] + rests_[image].charge_e[tap]);
      mean.number_dn[tap] = of_.per_exposure * (mean.number_dn[tap] + rests_[image].number_dn[tap]);
    }
    return mean;
  }

  PMDSIM_INLINED void demodulate(std::uint32_t image, const Reading &reading) {
    // What the camera takes for the image's correlation sample, in electrons; of one tap with all that is
    // common.
    const FloatBlock difference_e =
        of_.e_per_dn * (reading.number_dn[0] - (taps_ == 2 ? reading.number_dn[1] : filled(of_.offset_dn)));
    largest_ = larger(largest_, absolute(difference_e));
    read_z_ = {fused(of_.of_image * of_.reference[image][0], difference_e, read_z_.re),
               fused(of_.of_image * of_.reference[image][1], difference_e, read_z_.im)};
    if (!of_.taps_out)
      return;
    common_ += (0.5f * of_.of_image) * difference_e;
    differences_[image] = difference_e;
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      pixels_.store_to(of_.tap_e[tap][image], reading.charge_e[tap]);
      pixels_.store_to(of_.tap_dn[tap][image], reading.number_dn[tap]);
    }
  }

  PMDSIM_INLINED void store_return() {
    // Less than that is rounding: all numbers are alike.
    const FloatBlock least = 0x1p-20f * largest_;
    const IntBlock is_nothing = (absolute(read_z_.re) <= least) & (absolute(read_z_.im) <= least);
    const ComplexBlock z = {chosen(is_nothing, filled(0.0f), read_z_.re),
                            chosen(is_nothing, filled(0.0f), read_z_.im)};
    const FloatBlock size = exact_root(fused(z.re, z.re, z.im * z.im));
    const IntBlock is_known = size > 0.0f;
    const FloatBlock turns = phase_turns({chosen(is_known, z.re, filled(1.0f)), z.im});
    const FloatBlock nan = filled(not_a_number);
    pixels_.store_to(of_.amplitude_out, of_.radiance_per_e * size);
    pixels_.store_to(of_.phase_rad_out,
                     chosen(is_known, smaller(two_pi_float * turns, filled(of_.below_turn)), nan));
    pixels_.store_to(of_.distance_m_out,
                     chosen(is_known, smaller(of_.ambiguity_m * turns, filled(of_.below_m)), nan));
    const FloatBlock of_part2 = (0.5f * of_.of_image * of_.of_image * of_.per_exposure) * variance_;
    pixels_.store_to(of_.confidence, size * newton_inverse_root(of_part2));
    pixels_.store_to(of_.saturated, saturated_);
    if (of_.taps_out)
      for (std::uint32_t image = 0; image < of_.images; ++image) {
        const FloatBlock tap = two_tap ? differences_[image] : differences_[image] - common_;
        pixels_.store_to(of_.taps_out[image], of_.radiance_per_e * tap);
      }
  }

  // sigma_phi^2 = (2 / (N a))^2 sum_k variance_k sin^2(phi - theta_k), a the amplitude in electrons.
  PMDSIM_INLINED void store_noise() {
    const FloatBlock re2 = z_.re * z_.re, im2 = z_.im * z_.im, size2 = re2 + im2, per_size2 = 1.0f / size2;
    const FloatBlock cos2 = (re2 - im2) * per_size2, sin2 = 2.0f * z_.re * z_.im * per_size2;
    const FloatBlock across =
        0.5f * larger(variance_ - (second_.re * cos2 + second_.im * sin2), filled(0.0f));
    const FloatBlock phase_rad =
        (of_.of_image * of_.radiance_per_e) * exact_root(of_.per_exposure * across * per_size2);
    const FloatBlock fullest_dn = of_.gain_dn_per_e * fullest_ + of_.offset_dn;
    const IntBlock is_full = (fullest_ > of_.full_well_e) | (fullest_dn > of_.largest_dn);
    const IntBlock is_known = (size2 > 0.0f) & ~is_full;
    pixels_.store_to(of_.distance_noise_m,
                     chosen(is_known, (of_.ambiguity_m * turns_per_rad) * phase_rad, filled(not_a_number)));
  }

  static constexpr std::uint32_t taps_ = two_tap ? 2 : 1;
  const ElectronWork &of_;
  const Pixels<usual> pixels_;
  FixedPattern pattern_;
  Normals normals_, reads_;
  ComplexBlock z_{};
  FloatBlock variance_{}; // sum over the images
  ComplexBlock second_{}; // the same times exp(2 j theta_k)
  FloatBlock fullest_{};  // charge of all taps, in the mean
  IntBlock saturated_{};
  // Sums over the exposures, and what rounding took from them.
  Reading readings_[usual ? 1 : most_images], rests_[usual ? 1 : most_images];
  ComplexBlock read_z_{};           // what the camera makes of its numbers, electrons
  FloatBlock largest_{}, common_{}; // of the differences: the largest of them, and half of their mean
  FloatBlock differences_[most_images];
};

// Whether all of a block's taps are so bright that no electrons are counted one by one; no where that is
// close. `rounding` is more than the errors of the taps' means, relative to their terms.
PMDSIM_INLINED bool is_bright(const ElectronWork &of, const Pixels<true> &pixels) {
  constexpr float largest_normal = 6.7f, rounding = 1e-6f, close = 1.001f;
  const float least_response = of.prnu * largest_normal < 1.0f ? 1.0f - of.prnu * largest_normal : 0.0f;
  const FloatBlock background =
      of.background_e ? pixels.load_from(of.background_e) : filled(of.all_background_e);
  bool are_bright = true;
  for (std::uint32_t k = 0; k < (of.amplitude ? 1 : of.images); ++k) {
    const FloatBlock common = of.half_per_radiance * pixels.load_from(of.mean_radiance[k]) + background;
    const FloatBlock largest_part =
        of.part_per_correlation * absolute(pixels.load_from(of.amplitude ? of.amplitude : of.taps[k]));
    const FloatBlock darkest = (1.0f - rounding) * common - (1.0f + rounding) * largest_part;
    are_bright &= are_all_above(least_response * darkest + of.dark_e, close * largest_counted_mean);
  }
  return are_bright;
}

template <bool two_tap, bool merged, bool usual>
[[gnu::noinline]] void count_block(const ElectronWork &of, const Pixels<usual> &pixels) {
  PixelElectrons<two_tap, merged, usual>(of, pixels).count();
}

template <bool two_tap, bool merged>
void count_blocks(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  const bool are_usual = of.exposures == 1;
  for (std::uint32_t pixel = first; pixel < last; pixel += block_lanes) {
    const std::uint32_t left = last - pixel;
    if (are_usual && left >= block_lanes && is_bright(of, {pixel}))
      count_block<two_tap, merged, true>(of, {pixel});
    else
      count_block<two_tap, merged, false>(of,
                                          {pixel, left < block_lanes ? static_cast<int>(left) : block_lanes});
  }
}

void count_electrons(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  const bool merged = of.read_noise_e >= least_merged_noise_e;
  if (of.two_tap)
    return merged ? count_blocks<true, true>(of, first, last) : count_blocks<true, false>(of, first, last);
  return merged ? count_blocks<false, true>(of, first, last) : count_blocks<false, false>(of, first, last);
}

} // namespace

extern const ElectronLoops electron_loops;
const ElectronLoops electron_loops{count_electrons};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
