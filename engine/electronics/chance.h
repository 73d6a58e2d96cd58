#pragma once
// Random numbers of given distributions, in blocks of vectors. Every operation is rounded as IEEE 754 says,
// so that each instruction set gives the same bits.

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

// 1 / sqrt(v), to a relative error of 2e-7, by Newton's method alone: a division takes as long as ten
// products. Large, but a number, for v = 0.
PMDSIM_INLINED FloatBlock newton_inverse_root(const FloatBlock &v) {
  const FloatBlock minus_half = -0.5f * v;
  FloatBlock y = floats_of_bits(0x5f3759df - (bits_of_floats(v) >> 1));
  for (int i = 0; i < 3; ++i)
    y = y * fused(minus_half * y, y, 1.5f);
  return y;
}

// Natural logarithm of x in [2^-32, 1], to 1e-7 of it or of x - 1, whichever is larger: the polynomial of
// S. L. Moshier, Cephes library, logf.
PMDSIM_INLINED FloatBlock log_of_share(const FloatBlock &x) {
  const IntBlock exponent = (bits_of_floats(x * 1.41421356f) >> 23) - 127;
  const FloatBlock f = floats_of_bits(bits_of_floats(x) - (exponent << 23)) - 1.0f, f2 = f * f;
  FloatBlock p = fused(7.0376836292e-2f, f, -1.1514610310e-1f);
  constexpr float coefficients[] = {1.1676998740e-1f, -1.2420140846e-1f, 1.4249322787e-1f, -1.6668057665e-1f,
                                    2.0000714765e-1f, -2.4999993993e-1f, 3.3333331174e-1f};
  for (const float coefficient : coefficients)
    p = fused(p, f, coefficient);
  return fused(0.693147181f, converted(exponent), f + fused(f2 * f, p, -0.5f * f2));
}

struct ComplexBlock {
  FloatBlock re, im;
};

PMDSIM_INLINED ComplexBlock unit_phasor(const FloatBlock &turns) {
  const Block<Complex> phasors = each([](const Floats &x) { return unit_phasor(x); }, turns);
  return {each([](const Complex &z) { return z.re; }, phasors),
          each([](const Complex &z) { return z.im; }, phasors)};
}

// (cos, sin) of a word's 2^32nd parts of a turn: the polynomials of unit_phasor().
PMDSIM_INLINED ComplexBlock phasor_of_word(const IntBlock &word) {
  using Unsigned = std::uint32_t __attribute__((vector_size(vector_bytes)));
  const IntBlock quarter = each( // to the nearest, -2 to 1
      [](const Ints &x) { return reinterpret_cast<Ints>(reinterpret_cast<Unsigned>(x) + (1u << 29)) >> 30; },
      word);
  const IntBlock rest = each(
      [](const Ints &x, const Ints &q) {
        return reinterpret_cast<Ints>(reinterpret_cast<Unsigned>(x) - (reinterpret_cast<Unsigned>(q) << 30));
      },
      word, quarter);
  const FloatBlock y = converted(rest) * 0x1p-32f, u = y * y;
  FloatBlock s = fused(41.47283324f, u, -76.69786635f), c = fused(59.22016896f, u, -85.44284467f);
  constexpr float of_s[] = {81.60520471f, -41.34170215f, 6.283185307f},
                  of_c[] = {64.93931614f, -19.73920865f, 1.0f};
  for (const float coefficient : of_s)
    s = fused(s, u, coefficient);
  for (const float coefficient : of_c)
    c = fused(c, u, coefficient);
  s = s * y;
  const IntBlock is_odd = (quarter & 1) != 0,
                 turned = quarter << 30 & std::numeric_limits<std::int32_t>::min();
  const FloatBlock re = chosen(is_odd, -s, c), im = chosen(is_odd, c, s);
  return {floats_of_bits(bits_of_floats(re) ^ turned), floats_of_bits(bits_of_floats(im) ^ turned)};
}

struct NormalPair {
  FloatBlock first, second;
};

// Two independent standard normal numbers of two words: G. E. P. Box and M. E. Muller, "A note on the
// generation of random normal deviates", Ann. Math. Stat. 29 (1958). At most 6.7 from 0.
PMDSIM_INLINED NormalPair normal_pair(const IntBlock &radius_word, const IntBlock &angle_word) {
  const FloatBlock share = fused(0x1p-31f, converted(shifted_right(radius_word, 1)), 0x1p-32f); // in (0, 1]
  const FloatBlock radius = exact_root(larger(-2.0f * log_of_share(share), filled(0.0f)));
  const ComplexBlock at = phasor_of_word(angle_word);
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
