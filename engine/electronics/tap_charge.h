#pragma once
// The charge of a tap (docs/theory.md, "Electrons"): its mean, its fixed pattern, and the chance in it, in
// blocks of pixels.

#include "engine/electronics/chance.h"
#include "engine/electronics/electron_work.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

inline constexpr float least_rounded = 0x1p22f; // above it every float of a mean is whole enough

// A block's pixels, of which the first `count` are there; `whole`: all are.
template <bool whole>
struct Pixels {
  std::uint32_t first;
  int count = block_lanes;

  // Number of the first one of the block's vector i.
  std::uint32_t of_vector(int i) const { return first + static_cast<std::uint32_t>(lanes * i); }
  PMDSIM_INLINED IntBlock numbers() const {
    return block_of([&](int i) { return static_cast<std::int32_t>(of_vector(i)) + lane_numbers(); });
  }
  PMDSIM_INLINED FloatBlock load_from(const float *from) const {
    if constexpr (whole) {
      return block_of([&](int i) { return load<Floats>(from + of_vector(i)); });
    } else {
      FloatBlock values{};
      __builtin_memcpy(&values, from + first, sizeof(float) * static_cast<std::size_t>(count));
      return values;
    }
  }
  // `from`: pairs of pixel `first_there` and the next ones.
  PMDSIM_INLINED FloatBlockPair load_pairs_from(const float *from, std::uint32_t first_there) const {
    from += std::size_t{2} * (first - first_there);
    if constexpr (whole) {
      return pairs_apart(from);
    } else {
      alignas(vector_bytes) float pairs[2 * block_lanes]{};
      __builtin_memcpy(pairs, from, 2 * sizeof(float) * static_cast<std::size_t>(count));
      return pairs_apart(pairs);
    }
  }
  template <class V, class T>
  PMDSIM_INLINED void store_to(T *to, const Block<V> &values) const {
    if constexpr (whole)
      each_vector([&](int i) { store(to + of_vector(i), values.of[i]); });
    else
      __builtin_memcpy(to + first, &values, sizeof(T) * static_cast<std::size_t>(count));
  }
};

PMDSIM_INLINED Words4 words_of(const ElectronWork &of, const IntBlock &pixels, ChanceStream stream,
                               std::uint32_t call, std::uint32_t exposure) {
  const std::uint32_t shared[3] = {of.frame,
                                   of.frequency << 16 | static_cast<std::uint32_t>(stream) << 8 | call,
                                   of.sensor << 16 | exposure};
  return philox(pixels, shared, of.key);
}

// Offsets and relative responses of taps A and B, the same in every frame.
struct FixedPattern {
  FloatBlock response[2], offset_e[2];
};

inline FixedPattern fixed_pattern(const ElectronWork &of, const IntBlock &pixels, std::uint32_t part) {
  const std::uint32_t shared[3] = {0, static_cast<std::uint32_t>(ChanceStream::pattern) << 8,
                                   of.sensor << 16 | part};
  const Words4 words = philox(pixels, shared, of.key);
  const FloatBlockPair responses = normal_pair(words.of[0]), offsets = normal_pair(words.of[1]);
  const FloatBlock none = filled(0.0f);
  return {{larger(1.0f + of.prnu * responses.first, none), larger(1.0f + of.prnu * responses.second, none)},
          {of.dsnu_e * offsets.first, of.dsnu_e * offsets.second}};
}

// The noiseless light of a sine.
struct SineLight {
  FloatBlock amplitude; // |z|
  ComplexBlock z;
  FloatBlock mean_radiance;
};

PMDSIM_INLINED SineLight polar_light(const FloatBlock &amplitude, const FloatBlock &phase_rad,
                                     const FloatBlock &mean_radiance) {
  constexpr float turns_per_rad = 0.15915494f;
  const ComplexBlock phasor = unit_phasor(turns_per_rad * chosen(amplitude > 0.0f, phase_rad, filled(0.0f)));
  return {amplitude, {amplitude * phasor.re, amplitude * phasor.im}, mean_radiance};
}

template <bool whole>
PMDSIM_INLINED SineLight sine_light(const ElectronWork &of, const Pixels<whole> &pixels) {
  if (!of.return_pairs)
    return polar_light(pixels.load_from(of.amplitude), pixels.load_from(of.phase_rad),
                       pixels.load_from(of.mean_radiance[0]));
  const FloatBlockPair of_return = pixels.load_pairs_from(of.return_pairs, of.first_of_pairs);
  const FloatBlock mean_radiance = pixels.load_pairs_from(of.mean_pairs, of.first_of_pairs).first;
  if (!of.complex_returns)
    return polar_light(of_return.first, of_return.second, mean_radiance);
  const ComplexBlock z{of_return.first, of_return.second};
  return {magnitude_of_any(z), z, mean_radiance};
}

// What both taps have of the mean light's electrons and of the background's.
template <bool whole>
PMDSIM_INLINED FloatBlock common_light(const ElectronWork &of, const Pixels<whole> &pixels,
                                       const FloatBlock &mean_radiance) {
  const FloatBlock background =
      of.background ? of.all_background_e * pixels.load_from(of.background) : filled(of.all_background_e);
  return fused(of.half_per_radiance, mean_radiance, background);
}

// A number with the first four cumulants of Poisson's of that mean, plus a normal one of that variance, from
// a standard normal z: E. A. Cornish and R. A. Fisher, "Moments and cumulants in the specification of
// distributions", Rev. Inst. Int. Stat. 5 (1938). Both together are at least 1.
PMDSIM_INLINED FloatBlock merged_charge(const FloatBlock &mean, float noise_variance, const FloatBlock &z) {
  const FloatBlock deviation = exact_root(mean + noise_variance), inverse_deviation = 1.0f / deviation;
  const FloatBlock shot_share = mean * (inverse_deviation * inverse_deviation);
  const FloatBlock z2 = z * z, second = fused(1.0f / 6.0f, z2, -1.0f / 6.0f);
  const FloatBlock third =
      fused(-shot_share, fused(1.0f / 18.0f, z2, -5.0f / 36.0f), fused(1.0f / 24.0f, z2, -1.0f / 8.0f));
  return fused(shot_share, fused(z * inverse_deviation, third, second), fused(deviation, z, mean));
}

PMDSIM_INLINED FloatBlock whole_count(const FloatBlock &charge) {
  return chosen(charge < least_rounded, larger(rounded(charge), filled(0.0f)), charge);
}

// Standard normal numbers of an exposure; each tap that is read takes one.
struct Draws {
  FloatBlock of[2 * most_images];
};

// Two draws of a word. In a loop of its own, so that the processor has the next words' steps to make while
// one waits for its last.
[[gnu::noinline]] inline void draw_normals(const ElectronWork &of, const IntBlock &pixels,
                                           ChanceStream stream, std::uint32_t exposure, std::uint32_t draws,
                                           Draws &to) {
  for (std::uint32_t first = 0; first < draws; first += 8) {
    const Words4 words = words_of(of, pixels, stream, first / 8, exposure);
    for (std::uint32_t i = 0; i < 4 && first + 2 * i < draws; ++i) {
      const FloatBlockPair pair = normal_pair(words.of[i]);
      to.of[first + 2 * i] = pair.first;
      to.of[first + 2 * i + 1] = pair.second;
    }
  }
}

// The charge where the mean is small, elsewhere `charge`. By value: what has an address to hand over is kept
// in memory throughout.
[[gnu::noinline]] inline FloatBlock counted_charge(const ElectronWork &of, const IntBlock &pixels,
                                                   std::uint32_t exposure, std::uint32_t draw,
                                                   FloatBlock mean, FloatBlock z, FloatBlock charge) {
  const Words4 words = words_of(of, pixels, ChanceStream::counts, draw / 4, exposure);
  for (int i = 0; i < block_vectors; ++i) {
    const Ints is_small = mean.of[i] < largest_counted_mean;
    if (bits_of(is_small) == 0)
      continue;
    const Floats limited = smaller(mean.of[i], all(largest_counted_mean));
    const Floats counted = poisson(limited, words.of[draw % 4].of[i]) + of.read_noise_e * z.of[i];
    charge.of[i] = is_small ? counted : charge.of[i];
  }
  return charge;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
