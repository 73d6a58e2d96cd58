#pragma once
// Random numbers of given distributions, in vectors. Every operation is rounded as IEEE 754 says, so that
// each instruction set gives the same bits.

#include "engine/electronics/philox_lanes.h"
#include "engine/model/elementary_lanes.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Rounded correctly, unlike root().
inline Floats exact_root(const Floats &v) {
#if defined(__AVX512F__)
  return reinterpret_cast<Floats>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(v)));
#elif defined(__AVX2__)
  return reinterpret_cast<Floats>(_mm256_sqrt_ps(reinterpret_cast<__m256>(v)));
#else
  Floats roots;
  for (int i = 0; i < lanes; ++i)
    roots[i] = __builtin_sqrtf(v[i]);
  return roots;
#endif
}

struct NormalPair {
  Floats first, second;
};

// Two independent standard normal numbers of two words: G. E. P. Box and M. E. Muller, "A note on the
// generation of random normal deviates", Ann. Math. Stat. 29 (1958). At most 6.7 from 0.
inline NormalPair normal_pair(const Ints &radius_word, const Ints &angle_word) {
  using Unsigned = std::uint32_t __attribute__((vector_size(vector_bytes)));
  const Ints upper31 = reinterpret_cast<Ints>(reinterpret_cast<Unsigned>(radius_word) >> 1);
  const Floats share = (__builtin_convertvector(upper31, Floats) + 0.5f) * 0x1p-31f; // in (0, 1]
  const Floats radius = exact_root(larger(-2.0f * log_of(share, 1.0f - share), all(0.0f)));
  const Complex at = unit_phasor(__builtin_convertvector(angle_word, Floats) * 0x1p-32f);
  return {radius * at.re, radius * at.im};
}

// The largest mean of which Poisson's numbers are found one by one.
constexpr float largest_counted_mean = 64.0f;
constexpr int most_counts = 256; // of such a mean: beyond it lies less than 1e-70

// e^-x, x in [0, 64]: of a 64th by its series, then squared.
inline Doubles exp_of_negative(const Doubles &x) {
  const Doubles part = x * -0x1p-6;
  Doubles sum = part * 0.0 + 1.0;
  for (int k = 17; k > 0; --k)
    sum = sum * part * (1.0 / k) + 1.0;
  for (int i = 0; i < 6; ++i)
    sum *= sum;
  return sum;
}

inline Doubles poisson_of_half(const Doubles &mean, const Doubles &share) {
  Doubles chance = exp_of_negative(mean), sum = chance, count = {};
  for (int k = 1; k < most_counts; ++k) {
    const Longs more = share > sum;
    std::int64_t any = 0;
    for (int i = 0; i < double_lanes; ++i)
      any |= more[i];
    if (any == 0)
      break;
    count = more ? count + 1.0 : count;
    chance *= mean * (1.0 / k);
    sum += chance;
  }
  return count;
}

// Poisson's numbers by inversion of their distribution, of means up to largest_counted_mean: exact but for
// the 2^-32 that a word is coarse by.
inline Floats poisson(const Floats &mean, const Ints &word) {
  Wide shares;
  for (int i = 0; i < double_lanes; ++i) {
    shares.low[i] = (static_cast<double>(static_cast<std::uint32_t>(word[i])) + 0.5) * 0x1p-32;
    shares.high[i] =
        (static_cast<double>(static_cast<std::uint32_t>(word[i + double_lanes])) + 0.5) * 0x1p-32;
  }
  const Wide means = wide(mean);
  return narrow(Wide{poisson_of_half(means.low, shares.low), poisson_of_half(means.high, shares.high)});
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
