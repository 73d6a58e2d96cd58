#pragma once
// The charge of a tap (docs/theory.md, "Electrons"): its mean, its fixed pattern, and the chance in it, in
// vectors of pixels.

#include "engine/electronics/chance.h"
#include "engine/electronics/electron_work.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Vectors that a call hands over by memory cost more than what the callee does with them.
#define PMDSIM_INLINED [[gnu::always_inline]] inline

// At this read noise and above the steps of single electrons are gone: 3e-9 of them is left.
inline constexpr float least_merged_noise_e = 1.0f;
inline constexpr float least_rounded = 0x1p22f; // above it every float of a mean is whole enough

// A vector's pixels, of which the first `count` are there.
struct Pixels {
  std::uint32_t first;
  int count;

  Ints numbers() const { return static_cast<std::int32_t>(first) + lane_numbers(); }
  Floats load_from(const float *from) const {
    if (count == lanes)
      return load<Floats>(from + first);
    Floats values{};
    __builtin_memcpy(&values, from + first, sizeof(float) * static_cast<std::size_t>(count));
    return values;
  }
  template <class V, class T>
  void store_to(T *to, const V &values) const {
    if (count == lanes)
      return store(to + first, values);
    __builtin_memcpy(to + first, &values, sizeof(T) * static_cast<std::size_t>(count));
  }
};

PMDSIM_INLINED Words4 words_of(const ElectronWork &of, const Pixels &pixels, ChanceStream stream,
                               std::uint32_t call, std::uint32_t exposure) {
  const std::uint32_t shared[3] = {of.frame,
                                   of.frequency << 16 | static_cast<std::uint32_t>(stream) << 8 | call,
                                   of.sensor << 16 | exposure};
  return philox(pixels.numbers(), shared, of.key);
}

PMDSIM_INLINED NormalPair normals_of(const Words4 &words, int pair) {
  return pair == 0 ? normal_pair(words.of[0], words.of[1]) : normal_pair(words.of[2], words.of[3]);
}

// Offsets and relative responses of taps A and B, the same in every frame.
struct FixedPattern {
  Floats response[2], offset_e[2];
};

inline FixedPattern fixed_pattern(const ElectronWork &of, const Pixels &pixels, std::uint32_t part) {
  FixedPattern pattern{{all(1.0f), all(1.0f)}, {all(0.0f), all(0.0f)}};
  if (of.dsnu_e == 0.0f && of.prnu == 0.0f)
    return pattern;
  const std::uint32_t shared[3] = {0, static_cast<std::uint32_t>(ChanceStream::pattern) << 8,
                                   of.sensor << 16 | part};
  const Words4 words = philox(pixels.numbers(), shared, of.key);
  const NormalPair responses = normals_of(words, 0), offsets = normals_of(words, 1);
  pattern.response[0] = larger(1.0f + of.prnu * responses.first, all(0.0f));
  pattern.response[1] = larger(1.0f + of.prnu * responses.second, all(0.0f));
  pattern.offset_e[0] = of.dsnu_e * offsets.first;
  pattern.offset_e[1] = of.dsnu_e * offsets.second;
  return pattern;
}

// The mean electrons of an image's taps but for the fixed pattern.
struct TapMeans {
  Floats light[2]; // with the background
  float dark_e;    // of each tap

  Floats of(std::uint32_t tap) const { return light[tap] + dark_e; }
};

PMDSIM_INLINED TapMeans tap_means(const ElectronWork &of, const Pixels &pixels, std::uint32_t image,
                                  const Floats &correlation) {
  const Floats background = of.background_e ? pixels.load_from(of.background_e) : all(of.all_background_e);
  const Floats common =
      fused(all(of.half_per_radiance), pixels.load_from(of.mean_radiance[image]), background);
  const Floats part = of.part_per_correlation * correlation, none = all(0.0f);
  return {{larger(common + part, none), larger(common - part, none)}, of.dark_e};
}

// A number with the first four cumulants of Poisson's of that mean, plus a normal one of that variance, from
// a standard normal z: E. A. Cornish and R. A. Fisher, "Moments and cumulants in the specification of
// distributions", Rev. Inst. Int. Stat. 5 (1938). Both together are at least 1.
PMDSIM_INLINED Floats merged_charge(const Floats &mean, float noise_variance, const Floats &z) {
  const Floats variance = mean + noise_variance, inverse_deviation = newton_inverse_root(variance);
  const Floats shot_share = mean * inverse_deviation * inverse_deviation, z2 = z * z;
  const Floats second = fused(z2, all(1.0f / 6.0f), -1.0f / 6.0f);
  const Floats third = z * fused(-shot_share, fused(z2, all(1.0f / 18.0f), -5.0f / 36.0f),
                                 fused(z2, all(1.0f / 24.0f), -1.0f / 8.0f));
  return fused(variance * inverse_deviation, z,
               fused(shot_share, fused(third, inverse_deviation, second), mean));
}

PMDSIM_INLINED Floats whole_count(const Floats &charge) {
  return charge < least_rounded ? larger(rounded(charge), all(0.0f)) : charge;
}

// An exposure's draws, one for each tap that is read: draws 2 i and 2 i + 1 share a pair of normal numbers,
// and draws 4 i to 4 i + 3 a call of Philox. All of them at once, as each of them waits long for itself.
struct Normals {
  Floats of[2 * most_images];
};

PMDSIM_INLINED void draw_normals(const ElectronWork &of, const Pixels &pixels, ChanceStream stream,
                                 std::uint32_t exposure, std::uint32_t draws, Normals &normals) {
  for (std::uint32_t first = 0; first < draws; first += 4) {
    const Words4 words = words_of(of, pixels, stream, first / 4, exposure);
    const NormalPair pairs[2] = {normals_of(words, 0), normals_of(words, 1)};
    normals.of[first] = pairs[0].first;
    normals.of[first + 1] = pairs[0].second;
    normals.of[first + 2] = pairs[1].first;
    normals.of[first + 3] = pairs[1].second;
  }
}

// The charge of a small mean.
[[gnu::noinline]] inline Floats counted_charge(const ElectronWork &of, const Pixels &pixels,
                                               std::uint32_t exposure, std::uint32_t draw, const Floats &mean,
                                               const Floats &z) {
  const Words4 words = words_of(of, pixels, ChanceStream::counts, draw / 4, exposure);
  return poisson(smaller(mean, all(largest_counted_mean)), words.of[draw % 4]) + of.read_noise_e * z;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
