#pragma once
// The charge of a tap (docs/theory.md, "Electrons"): its mean, its fixed pattern, and the chance in it, in
// blocks of pixels.

#include "engine/electronics/chance.h"
#include "engine/electronics/electron_work.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// At this read noise and above the steps of single electrons are gone: 3e-9 of them is left.
inline constexpr float least_merged_noise_e = 1.0f;
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

PMDSIM_INLINED NormalPair normals_of(const Words4 &words, int pair) {
  return pair == 0 ? normal_pair(words.of[0], words.of[1]) : normal_pair(words.of[2], words.of[3]);
}

// Offsets and relative responses of taps A and B, the same in every frame.
struct FixedPattern {
  FloatBlock response[2], offset_e[2];
};

inline FixedPattern fixed_pattern(const ElectronWork &of, const IntBlock &pixels, std::uint32_t part) {
  const std::uint32_t shared[3] = {0, static_cast<std::uint32_t>(ChanceStream::pattern) << 8,
                                   of.sensor << 16 | part};
  const Words4 words = philox(pixels, shared, of.key);
  const NormalPair responses = normals_of(words, 0), offsets = normals_of(words, 1);
  const FloatBlock none = filled(0.0f);
  return {{larger(1.0f + of.prnu * responses.first, none), larger(1.0f + of.prnu * responses.second, none)},
          {of.dsnu_e * offsets.first, of.dsnu_e * offsets.second}};
}

// The mean electrons of an image's taps but for the fixed pattern.
struct TapMeans {
  FloatBlock light[2]; // with the background
  float dark_e;        // of each tap

  FloatBlock of(std::uint32_t tap) const { return light[tap] + dark_e; }
};

template <bool whole>
PMDSIM_INLINED TapMeans tap_means(const ElectronWork &of, const Pixels<whole> &pixels, std::uint32_t image,
                                  const FloatBlock &correlation) {
  const FloatBlock background =
      of.background_e ? pixels.load_from(of.background_e) : filled(of.all_background_e);
  const FloatBlock common =
      fused(of.half_per_radiance, pixels.load_from(of.mean_radiance[image]), background);
  const FloatBlock part = of.part_per_correlation * correlation, none = filled(0.0f);
  return {{larger(common + part, none), larger(common - part, none)}, of.dark_e};
}

// A number with the first four cumulants of Poisson's of that mean, plus a normal one of that variance, from
// a standard normal z: E. A. Cornish and R. A. Fisher, "Moments and cumulants in the specification of
// distributions", Rev. Inst. Int. Stat. 5 (1938). Both together are at least 1.
PMDSIM_INLINED FloatBlock merged_charge(const FloatBlock &mean, float noise_variance, const FloatBlock &z) {
  const FloatBlock variance = mean + noise_variance, inverse_deviation = newton_inverse_root(variance);
  const FloatBlock shot_share = mean * inverse_deviation * inverse_deviation, z2 = z * z;
  const FloatBlock second = fused(1.0f / 6.0f, z2, -1.0f / 6.0f);
  const FloatBlock third =
      z * fused(-shot_share, fused(1.0f / 18.0f, z2, -5.0f / 36.0f), fused(1.0f / 24.0f, z2, -1.0f / 8.0f));
  return fused(variance * inverse_deviation, z,
               fused(shot_share, fused(third, inverse_deviation, second), mean));
}

PMDSIM_INLINED FloatBlock whole_count(const FloatBlock &charge) {
  return chosen(charge < least_rounded, larger(rounded(charge), filled(0.0f)), charge);
}

// Four of an exposure's draws of standard normal numbers, from draw 4 `call` on; each tap that is read takes
// one.
struct Normals {
  FloatBlock of[4];
};
PMDSIM_INLINED Normals normals_of(const ElectronWork &of, const IntBlock &pixels, ChanceStream stream,
                                  std::uint32_t exposure, std::uint32_t call) {
  const Words4 words = words_of(of, pixels, stream, call, exposure);
  const NormalPair pairs[2] = {normals_of(words, 0), normals_of(words, 1)};
  return {{pairs[0].first, pairs[0].second, pairs[1].first, pairs[1].second}};
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
