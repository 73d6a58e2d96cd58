#pragma once
// Random numbers of given distributions, in vectors. Every operation is rounded as IEEE 754 says, so that
// each instruction set gives the same bits.

#include "engine/electronics/philox_lanes.h"
#include "engine/model/elementary_lanes.h"

#include <limits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

using UnsignedInts = std::uint32_t __attribute__((vector_size(vector_bytes)));

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
inline Floats fused(const Floats &a, const Floats &b, float c) { return fused(a, b, all(c)); }

// 1 / sqrt(v), to a relative error of 2e-7, by Newton's method alone: a division takes as long as ten
// products. Large, but a number, for v = 0.
inline Floats newton_inverse_root(const Floats &v) {
  const Floats half = 0.5f * v;
  Floats y = reinterpret_cast<Floats>(0x5f3759df - (reinterpret_cast<Ints>(v) >> 1));
  for (int i = 0; i < 3; ++i)
    y *= fused(-half * y, y, 1.5f);
  return y;
}

// Natural logarithm of x in [2^-32, 1], to 1e-7 of it or of x - 1, whichever is larger: the polynomial of
// S. L. Moshier, Cephes library, logf.
inline Floats log_of_share(const Floats &x) {
  const Ints exponent = (reinterpret_cast<Ints>(x * 1.41421356f) >> 23) - 127;
  const Floats f = reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) - (exponent << 23)) - 1.0f, f2 = f * f;
  Floats p = fused(f, all(7.0376836292e-2f), -1.1514610310e-1f);
  constexpr float coefficients[] = {1.1676998740e-1f, -1.2420140846e-1f, 1.4249322787e-1f, -1.6668057665e-1f,
                                    2.0000714765e-1f, -2.4999993993e-1f, 3.3333331174e-1f};
  for (const float coefficient : coefficients)
    p = fused(p, f, coefficient);
  const Floats whole = __builtin_convertvector(exponent, Floats);
  return fused(whole, all(0.693147181f), f + fused(f2 * f, p, -0.5f * f2));
}

// (cos, sin) of a word's 2^32nd parts of a turn: the polynomials of unit_phasor().
inline Complex phasor_of_word(const Ints &word) {
  const auto bits = reinterpret_cast<UnsignedInts>(word);
  const Ints quarter = reinterpret_cast<Ints>(bits + (1u << 29)) >> 30; // to the nearest, -2 to 1
  const auto rest = reinterpret_cast<Ints>(bits - (reinterpret_cast<UnsignedInts>(quarter) << 30));
  const Floats y = __builtin_convertvector(rest, Floats) * 0x1p-32f, u = y * y;
  Floats s = fused(u, all(41.47283324f), -76.69786635f), c = fused(u, all(59.22016896f), -85.44284467f);
  constexpr float of_s[] = {81.60520471f, -41.34170215f, 6.283185307f},
                  of_c[] = {64.93931614f, -19.73920865f, 1.0f};
  for (const float coefficient : of_s)
    s = fused(s, u, coefficient);
  for (const float coefficient : of_c)
    c = fused(c, u, coefficient);
  s *= y;
  const Ints is_odd = (quarter & 1) != 0, turned = quarter << 30 & std::numeric_limits<std::int32_t>::min();
  const Floats re = is_odd ? -s : c, im = is_odd ? c : s;
  return {reinterpret_cast<Floats>(reinterpret_cast<Ints>(re) ^ turned),
          reinterpret_cast<Floats>(reinterpret_cast<Ints>(im) ^ turned)};
}

struct NormalPair {
  Floats first, second;
};

// Two independent standard normal numbers of two words: G. E. P. Box and M. E. Muller, "A note on the
// generation of random normal deviates", Ann. Math. Stat. 29 (1958). At most 6.7 from 0.
inline NormalPair normal_pair(const Ints &radius_word, const Ints &angle_word) {
  const auto upper31 = reinterpret_cast<Ints>(reinterpret_cast<UnsignedInts>(radius_word) >> 1);
  const Floats share = fused(__builtin_convertvector(upper31, Floats), all(0x1p-31f), 0x1p-32f); // in (0, 1]
  const Floats radius = exact_root(larger(-2.0f * log_of_share(share), all(0.0f)));
  const Complex at = phasor_of_word(angle_word);
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
