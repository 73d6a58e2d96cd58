#pragma once
// Random numbers of given distributions, in blocks of vectors. Every operation is rounded as IEEE 754 says,
// so that each instruction set gives the same bits.

#include "engine/electronics/electron_work.h"
#include "engine/electronics/philox_lanes.h"

#include <limits>

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
PMDSIM_INLINED FloatBlock exact_root(const FloatBlock &a) {
  return each([](const Floats &x) { return exact_root(x); }, a);
}

// a b + c, rounded once on every processor.
inline Floats fused(const Floats &a, const Floats &b, const Floats &c) {
#if defined(__AVX512F__) || defined(__FMA__) || defined(__aarch64__)
  return multiply_add(a, b, c);
#else
  Floats sum;
  for (int i = 0; i < lanes; ++i)
    sum[i] = __builtin_fmaf(a[i], b[i], c[i]);
  return sum;
#endif
}
PMDSIM_INLINED FloatBlock fused(const FloatBlock &a, const FloatBlock &b, const FloatBlock &c) {
  return each([](const Floats &x, const Floats &y, const Floats &z) { return fused(x, y, z); }, a, b, c);
}
PMDSIM_INLINED FloatBlock fused(const FloatBlock &a, const FloatBlock &b, float c) {
  return fused(a, b, filled(c));
}
PMDSIM_INLINED FloatBlock fused(float a, const FloatBlock &b, const FloatBlock &c) {
  return fused(filled(a), b, c);
}
PMDSIM_INLINED FloatBlock fused(float a, const FloatBlock &b, float c) {
  return fused(filled(a), b, filled(c));
}

// -2 ln x, x in [2^-32, 1), to a relative error of 8e-6.
PMDSIM_INLINED FloatBlock minus_two_log(const FloatBlock &x) {
  constexpr std::int32_t root_of_half = 0x3f3504f3; // its bits
  const IntBlock bits = bits_of_floats(x), exponent = (bits - root_of_half) >> 23;
  const FloatBlock f = floats_of_bits(bits - (exponent << 23)) - 1.0f;
  FloatBlock p = fused(0.285841497f, f, -0.441118741f);
  constexpr float coefficients[] = {0.508065384f, -0.665160469f, 0.999804351f, -2.00000912f};
  for (const float coefficient : coefficients)
    p = fused(p, f, coefficient);
  return fused(-1.38629436f, converted(exponent), p * f);
}

struct ComplexBlock {
  FloatBlock re, im;
};

PMDSIM_INLINED FloatBlock magnitude(const ComplexBlock &z) {
  return exact_root(fused(z.re, z.re, z.im * z.im));
}
// The same where the squares are no numbers that a float can hold.
PMDSIM_INLINED FloatBlock magnitude_of_any(const ComplexBlock &z) {
  const FloatBlock x = absolute(z.re), y = absolute(z.im), longer = larger(x, y), t = smaller(x, y) / longer;
  return chosen(longer > 0.0f, longer * exact_root(fused(t, t, 1.0f)), filled(0.0f));
}

PMDSIM_INLINED ComplexBlock unit_phasor(const FloatBlock &turns) {
  const Block<Complex> phasors = each([](const Floats &x) { return unit_phasor(x); }, turns);
  return {each([](const Complex &z) { return z.re; }, phasors),
          each([](const Complex &z) { return z.im; }, phasors)};
}

// Two standard normal numbers of a word: G. E. P. Box and M. E. Muller, "A note on the generation of random
// normal deviates", Ann. Math. Stat. 29 (1958). Its upper 20 bits give the radius, at most largest_normal,
// the other 12 the angle: 10 within a quarter of a turn, and two signs. To 5e-6 of the radius.
PMDSIM_INLINED FloatBlockPair normal_pair(const IntBlock &word) {
  const IntBlock share_bits = (shifted_right(word, 9) & 0x007ffff8) | 0x3f800004;
  const FloatBlock radius = exact_root(minus_two_log(floats_of_bits(share_bits) - 1.0f));
  // From the quarter's middle, in 2048ths of half a turn.
  const FloatBlock y = floats_of_bits((word & 0x7fe) | 0x4a800000) - 4194815.5f, u = y * y;
  const FloatBlock sine = y * fused(fused(4.89491581e-17f, u, -4.25286756e-10f), u, 0.00108468658f);
  const FloatBlock cosine =
      fused(fused(fused(-1.25108045e-20f, u, 1.63089413e-13f), u, -8.31942821e-07f), u, 0.707106758f);
  const auto turned = [](const FloatBlock &value, const IntBlock &sign) {
    return floats_of_bits(bits_of_floats(value) ^ (sign & std::numeric_limits<std::int32_t>::min()));
  };
  return {turned(radius * (cosine - sine), word << 20), turned(radius * (cosine + sine), word << 31)};
}

constexpr int most_counts = 256; // of largest_counted_mean: beyond it lies less than 1e-70

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
