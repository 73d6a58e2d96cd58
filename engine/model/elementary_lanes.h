#pragma once
// Elementary functions of vectors, angles in turns: those of shaders/shared/elementary.glsl, with their
// polynomials.

#include "engine/model/wide_lanes.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

struct Complex {
  Floats re, im;
};

inline Complex operator+(const Complex &a, const Complex &b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator*(const Complex &a, const Complex &b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Complex operator*(const Floats &a, const Complex &b) { return {a * b.re, a * b.im}; }

// To the nearest whole number, of sizes up to 2^22.
inline Floats rounded(const Floats &v) {
  constexpr float shift = 0x1.8p23f;
  return (v + shift) - shift;
}

// What is left of turns beyond the nearest whole one.
inline Floats turn_fraction(const Wide &turns) { return narrow(turns - rounded(turns)); }

// (cos, sin) of 2 pi `turns`, for turns from -1/2 to 1.
inline Complex unit_phasor(const Floats &turns) {
  const Floats quarter = rounded(4.0f * turns), y = turns - 0.25f * quarter, u = y * y;
  const Floats s =
      y * (6.283185307f + u * (-41.34170215f + u * (81.60520471f + u * (-76.69786635f + u * 41.47283324f))));
  const Floats c = 1.0f + u * (-19.73920865f + u * (64.93931614f + u * (-85.44284467f + u * 59.22016896f)));
  const Ints q = __builtin_convertvector(quarter, Ints), is_odd = (q & 1) != 0, is_turned = (q & 2) != 0;
  const Floats re = is_odd ? -s : c, im = is_odd ? c : s;
  return {is_turned ? -re : re, is_turned ? -im : im};
}

// The angle of z in turns, in [-1/2, 1/2]; no number where z is zero.
inline Floats angle_turns(const Complex &z) {
  const Floats x = absolute(z.re), y = absolute(z.im), longer = larger(x, y), shorter = smaller(x, y);
  const Ints near_diagonal = shorter > 0.41421356f * longer;
  // Beyond tan(pi/8) it is taken from the diagonal, in double, as both sums would cancel digits of floats.
  const Wide numerator = wide(shorter) - wide(near_diagonal ? longer : all(0.0f)),
             denominator = wide(longer) + wide(near_diagonal ? shorter : all(0.0f));
  const Floats t = narrow(numerator / denominator), u = t * t;
  Floats angle =
      t * (0.159154943f +
           u * (-0.05305160562f +
                u * (0.03182809684f + u * (-0.02266292012f + u * (0.01682240502f + u * -0.009591162656f)))));
  angle += near_diagonal ? all(0.125f) : all(0.0f);
  angle = y > x ? 0.25f - angle : angle;
  angle = z.re < 0.0f ? 0.5f - angle : angle;
  return z.im < 0.0f ? -angle : angle;
}

// Natural logarithm of x = 1 - s, given both so that neither end loses digits; x in [1e-37, 2.3].
inline Floats log_of(const Floats &x, const Floats &s) {
  const Ints near_one = x > 0.5f;
  const Ints biased = reinterpret_cast<Ints>(x * 1.4142135f) >> 23;
  const Ints exponent = near_one ? all(0) : biased - 127; // x / 2^exponent in [0.71, 1.42)
  const Floats m = reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) - (exponent << 23));
  const Floats y = (near_one ? -s : m - 1.0f) / (m + 1.0f), u = y * y;
  const Floats log_m =
      y * (2.0f + u * (0.6666667903f +
                       u * (0.3999871125f + u * (0.2862020741f + u * (0.2139856051f + u * 0.2439390808f)))));
  return log_m + __builtin_convertvector(exponent, Floats) * 0.69314718f;
}

// e^x for x <= 87; 0 below 2^-126.
inline Floats exp_of(const Floats &x) {
  const Floats limited = larger(x, all(-128.0f)), k = larger(rounded(limited * 1.44269504f), all(-127.0f));
  const Floats f = (limited - k * 0.693359375f) + k * 2.12194440e-4f; // x - k ln 2, ln 2 in two parts
  const Floats p =
      1.0f + f * (1.0f + f * (0.5f + f * (0.1666641551f + f * (0.0416663529f + f * (0.008375126398f +
                                                                                    f * 0.001394110843f)))));
  const Ints scale = (__builtin_convertvector(k, Ints) + 127) << 23;
  return k < -126.0f ? all(0.0f) : p * reinterpret_cast<Floats>(scale);
}

// By squaring.
inline Floats whole_power(Floats x, std::uint32_t power) {
  Floats result = all(1.0f);
  for (; power > 0; power /= 2, x *= x)
    if (power % 2 == 1)
      result *= x;
  return result;
}

// x to a power below 1, x in [0, 2.3].
inline Floats fraction_of_power(const Floats &x, float power) {
  if (power == 0.0f)
    return all(1.0f);
  const Floats limited = larger(x, all(1e-37f)), result = exp_of(power * log_of(limited, 1.0f - limited));
  return x > 0.0f ? result : all(0.0f);
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
