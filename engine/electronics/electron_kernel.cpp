// A pixel's electrons, from the mean light to what the camera makes of its digital numbers (docs/theory.md,
// "Electrons"), in vectors of pixels.

#include "engine/electronics/tap_charge.h"

#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t usual_images = 4;
constexpr float two_pi_float = 6.2831853f, turns_per_rad = 0.15915494f;

// What the camera reads of an image: taps' electrons before the ADC, and digital numbers.
struct Reading {
  Floats charge_e[2], number_dn[2];
};

// Takes from both taps alike what would not fit into the fuller one's well.
void suppress_background(const ElectronWork &of, Reading &reading) {
  const Floats none = all(0.0f);
  const Floats over = larger(larger(reading.charge_e[0], reading.charge_e[1]) - of.full_well_e, none);
  const Floats common = larger(smaller(reading.charge_e[0], reading.charge_e[1]), none);
  const Floats taken = smaller(smaller(over, all(of.sbi_e)), common);
  reading.charge_e[0] -= taken;
  reading.charge_e[1] -= taken;
}

// The lanes where the tap is full, or beyond the ADC's range.
PMDSIM_INLINED Ints read_tap(const ElectronWork &of, Reading &reading, std::uint32_t tap) {
  Floats &charge = reading.charge_e[tap];
  const Ints is_full = charge > of.full_well_e;
  charge = smaller(charge, all(of.full_well_e));
  const Floats voltage_dn = fused(all(of.gain_dn_per_e), charge, of.offset_dn);
  reading.number_dn[tap] = rounded(smaller(larger(voltage_dn, all(0.0f)), all(of.largest_dn)));
  return is_full | (voltage_dn > of.largest_dn + 0.5f);
}

// The angle of z in turns, in [0, 1), to 1e-7: more than noise leaves of it. Twice as fast as angle_turns().
PMDSIM_INLINED Floats phase_turns(const Complex &z) {
  const Floats x = absolute(z.re), y = absolute(z.im), longer = larger(x, y), shorter = smaller(x, y);
  const Ints near_diagonal = shorter > 0.41421356f * longer;
  const Floats t = (near_diagonal ? shorter - longer : shorter) / (near_diagonal ? shorter + longer : longer);
  const Floats u = t * t;
  Floats angle = fused(u, all(-0.009591162656f), 0.01682240502f);
  constexpr float coefficients[] = {-0.02266292012f, 0.03182809684f, -0.05305160562f, 0.159154943f};
  for (const float coefficient : coefficients)
    angle = fused(angle, u, coefficient);
  angle = fused(angle, t, near_diagonal ? all(0.125f) : all(0.0f));
  angle = y > x ? 0.25f - angle : angle;
  angle = z.re < 0.0f ? 0.5f - angle : angle;
  const Floats turns = z.im < 0.0f ? 1.0f - angle : angle;
  return turns < 1.0f ? turns : all(0.0f);
}

// A sum of many readings is as exact as one of few: W. Kahan, "Further remarks on reducing truncation
// errors", CACM 8 (1965).
PMDSIM_INLINED void add_exactly(Floats &sum, Floats &rest, const Floats &term) {
  const Floats whole = sum + term;
  rest += term - (whole - sum);
  sum = whole;
}

struct Correlations {
  Floats of[most_images];
};

// A vector of pixels. `usual`: of one exposure and four images, so that the loops over them are unrolled.
template <bool two_tap, bool merged, bool usual>
class PixelElectrons {
public:
  PixelElectrons(const ElectronWork &of, const Pixels &pixels)
      : of_(of), pixels_(pixels), pattern_(fixed_pattern(of, pixels, 0)) {
    for (std::uint32_t k = 0; exposures() > 1 && k < images(); ++k)
      images_[k] = rests_[k] = {};
  }

  void count() {
    find_light();
    for (std::uint32_t exposure = 0; exposure < exposures(); ++exposure) {
      begin_exposure(exposure);
      for (std::uint32_t image = 0; image < images(); ++image)
        expose(exposure, image);
    }
    demodulate();
    store_noise();
  }

private:
  std::uint32_t images() const { return usual ? usual_images : of_.images; }
  std::uint32_t exposures() const { return usual ? 1 : of_.exposures; }

  // The noiseless z and correlation samples.
  PMDSIM_INLINED void find_light() {
    if (of_.amplitude) {
      const Floats amplitude = pixels_.load_from(of_.amplitude), phase_rad = pixels_.load_from(of_.phase_rad);
      const Ints is_lit = amplitude > 0.0f;
      Floats turns = turns_per_rad * (is_lit ? phase_rad : all(0.0f));
      turns -= turns > 0.5f ? all(1.0f) : all(0.0f);
      z_ = amplitude * unit_phasor(turns);
    }
    for (std::uint32_t k = 0; k < images(); ++k) {
      const auto &[re, im] = of_.reference[k];
      light_.of[k] = of_.amplitude ? re * z_.re + im * z_.im : pixels_.load_from(of_.taps[k]);
      if (!of_.amplitude)
        z_ = {z_.re + (of_.of_image * re) * light_.of[k], z_.im + (of_.of_image * im) * light_.of[k]};
    }
  }

  PMDSIM_INLINED void begin_exposure(std::uint32_t exposure) {
    if (!usual && of_.parts > 1)
      pattern_ = fixed_pattern(of_, pixels_, exposure % of_.parts);
    const std::uint32_t draws = taps_ * images();
    draw_normals(of_, pixels_, ChanceStream::normals, exposure, draws, normals_);
    if (!merged && of_.read_noise_e > 0.0f)
      draw_normals(of_, pixels_, ChanceStream::reads, exposure, draws, reads_);
  }

  PMDSIM_INLINED void expose(std::uint32_t exposure, std::uint32_t image) {
    const TapMeans means = tap_means(of_, pixels_, image, light_.of[image]);
    if (exposure == 0)
      predict(image, means);
    Reading reading{};
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      const Floats mean = fused(pattern_.response[tap], means.light[tap], means.dark_e);
      reading.charge_e[tap] = charge(exposure, taps_ * image + tap, mean) + pattern_.offset_e[tap];
    }
    add(image, reading);
  }

  PMDSIM_INLINED void demodulate() {
    Floats difference[most_images], mean = all(0.0f), largest = all(0.0f);
    Complex z{};
    for (std::uint32_t k = 0; k < images(); ++k) {
      const Reading reading = mean_reading(k);
      for (std::uint32_t tap = 0; of_.taps_out && tap < taps_; ++tap) {
        pixels_.store_to(of_.tap_e[tap][k], reading.charge_e[tap]);
        pixels_.store_to(of_.tap_dn[tap][k], reading.number_dn[tap]);
      }
      difference[k] = difference_e(reading);
      mean += (0.5f * of_.of_image) * difference[k];
      largest = larger(largest, absolute(difference[k]));
      const auto &[re, im] = of_.reference[k];
      z = {fused(all(of_.of_image * re), difference[k], z.re),
           fused(all(of_.of_image * im), difference[k], z.im)};
    }
    // Less than that is rounding: all numbers are alike.
    const Ints is_nothing = (absolute(z.re) <= 0x1p-20f * largest) & (absolute(z.im) <= 0x1p-20f * largest);
    store_return({is_nothing ? all(0.0f) : z.re, is_nothing ? all(0.0f) : z.im});
    if (!of_.taps_out)
      return;
    for (std::uint32_t k = 0; k < images(); ++k)
      pixels_.store_to(of_.taps_out[k],
                       of_.radiance_per_e * (taps_ == 2 ? difference[k] : difference[k] - mean));
  }

  // sigma_phi^2 = (2 / (N a))^2 sum_k variance_k sin^2(phi - theta_k), a the amplitude in electrons.
  void store_noise() {
    const Floats re2 = z_.re * z_.re, im2 = z_.im * z_.im, size2 = re2 + im2, per_size2 = 1.0f / size2;
    const Floats cos2 = (re2 - im2) * per_size2, sin2 = 2.0f * z_.re * z_.im * per_size2;
    const Floats across = 0.5f * larger(variance_ - (second_.re * cos2 + second_.im * sin2), all(0.0f));
    const Floats phase_rad =
        (of_.of_image * of_.radiance_per_e) * exact_root(of_.per_exposure * across * per_size2);
    const Floats fullest_dn = of_.gain_dn_per_e * fullest_ + of_.offset_dn;
    const Ints is_full = (fullest_ > of_.full_well_e) | (fullest_dn > of_.largest_dn);
    const Ints is_known = (size2 > 0.0f) & ~is_full;
    pixels_.store_to(of_.distance_noise_m,
                     is_known ? (of_.ambiguity_m * turns_per_rad) * phase_rad : all(not_a_number));
  }

  // The variance of the image's reading, and whether its taps are to be full.
  PMDSIM_INLINED void predict(std::uint32_t image, const TapMeans &means) {
    Floats variance = all(0.0f);
    Floats fullest = means.of(0);
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      variance += means.of(tap) + of_.reading_variance_e2;
      fullest = larger(fullest, means.of(tap));
    }
    if (taps_ == 2 && of_.sbi_e > 0.0f) {
      const Floats over = larger(fullest - of_.full_well_e, all(0.0f));
      fullest -= smaller(over, smaller(all(of_.sbi_e), smaller(means.of(0), means.of(1))));
    }
    fullest_ = larger(fullest_, fullest);
    const auto &[re, im] = of_.twice_reference[image];
    variance_ += variance;
    second_ = {second_.re + re * variance, second_.im + im * variance};
  }

  // The electrons of a tap of that mean, with its read noise. `merged`: both are drawn as one.
  PMDSIM_INLINED Floats charge(std::uint32_t exposure, std::uint32_t draw, const Floats &mean) {
    const Floats &z = normals_.of[draw];
    Floats charge;
    if (merged) {
      charge = merged_charge(mean, of_.read_noise_e * of_.read_noise_e, z);
    } else {
      charge = whole_count(merged_charge(larger(mean, all(1.0f)), 0.0f, z));
      charge += of_.read_noise_e > 0.0f ? of_.read_noise_e * reads_.of[draw] : all(0.0f);
    }
    const Ints is_small = mean < largest_counted_mean;
    if (bits_of(is_small) != 0)
      charge = is_small ? counted_charge(of_, pixels_, exposure, draw, mean, z) : charge;
    return charge;
  }

  PMDSIM_INLINED void add(std::uint32_t image, Reading reading) {
    if (two_tap && of_.sbi_e > 0.0f)
      suppress_background(of_, reading);
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      const Ints is_full = read_tap(of_, reading, tap);
      saturated_ |= is_full & static_cast<std::int32_t>(1u << (16 * tap + image));
    }
    if (exposures() == 1) {
      images_[image] = reading;
      return;
    }
    for (std::uint32_t tap = 0; tap < taps_; ++tap) {
      add_exactly(images_[image].charge_e[tap], rests_[image].charge_e[tap], reading.charge_e[tap]);
      add_exactly(images_[image].number_dn[tap], rests_[image].number_dn[tap], reading.number_dn[tap]);
    }
  }

  // Of all exposures.
  PMDSIM_INLINED Reading mean_reading(std::uint32_t image) const {
    Reading mean = images_[image];
    for (std::uint32_t tap = 0; exposures() > 1 && tap < taps_; ++tap) {
      mean.charge_e[tap] = of_.per_exposure * (mean.charge_e[tap] + rests_[image].charge_e[tap]);
      mean.number_dn[tap] = of_.per_exposure * (mean.number_dn[tap] + rests_[image].number_dn[tap]);
    }
    return mean;
  }

  // What the camera takes for the image's correlation sample, in electrons; of one tap with all that is
  // common.
  Floats difference_e(const Reading &reading) const {
    return of_.e_per_dn * (reading.number_dn[0] - (taps_ == 2 ? reading.number_dn[1] : all(of_.offset_dn)));
  }

  void store_return(const Complex &z) {
    const Floats size = exact_root(fused(z.re, z.re, z.im * z.im));
    const Ints is_known = size > 0.0f;
    const Floats turns = phase_turns({is_known ? z.re : all(1.0f), z.im});
    const Floats nan = all(not_a_number);
    pixels_.store_to(of_.amplitude_out, of_.radiance_per_e * size);
    pixels_.store_to(of_.phase_rad_out, is_known ? smaller(two_pi_float * turns, all(of_.below_turn)) : nan);
    pixels_.store_to(of_.distance_m_out, is_known ? smaller(of_.ambiguity_m * turns, all(of_.below_m)) : nan);
    const Floats of_part2 = (0.5f * of_.of_image * of_.of_image * of_.per_exposure) * variance_;
    pixels_.store_to(of_.confidence, size * newton_inverse_root(of_part2));
    pixels_.store_to(of_.saturated, saturated_);
  }

  static constexpr std::uint32_t taps_ = two_tap ? 2 : 1;
  const ElectronWork &of_;
  const Pixels &pixels_;
  FixedPattern pattern_;
  Normals normals_, reads_;
  Complex z_{};
  Correlations light_;
  Floats variance_{}; // sum over the images
  Complex second_{};  // the same times exp(2 j theta_k)
  Floats fullest_{};  // charge of all taps, in the mean
  Ints saturated_{};
  Reading images_[most_images],
      rests_[most_images]; // sums over the exposures, and what rounding took from them
};

template <bool two_tap, bool merged, bool usual>
void count_vectors(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  for (std::uint32_t pixel = first; pixel < last; pixel += lanes) {
    const std::uint32_t left = last - pixel;
    const Pixels pixels{pixel, left < lanes ? static_cast<int>(left) : lanes};
    PixelElectrons<two_tap, merged, usual>(of, pixels).count();
  }
}

template <bool two_tap, bool merged>
void count_exposures(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  if (of.exposures == 1 && of.images == usual_images)
    return count_vectors<two_tap, merged, true>(of, first, last);
  count_vectors<two_tap, merged, false>(of, first, last);
}

void count_electrons(const ElectronWork &of, std::uint32_t first, std::uint32_t last) {
  const bool merged = of.read_noise_e >= least_merged_noise_e;
  if (of.two_tap)
    return merged ? count_exposures<true, true>(of, first, last)
                  : count_exposures<true, false>(of, first, last);
  return merged ? count_exposures<false, true>(of, first, last)
                : count_exposures<false, false>(of, first, last);
}

} // namespace

extern const ElectronLoops electron_loops;
const ElectronLoops electron_loops{count_electrons};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
