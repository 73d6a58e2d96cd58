#pragma once
// Doubles beside a vector of floats, one for each of its lanes, for what floats are not exact enough for. The
// masked forms of intrinsics are there as in lanes.h.

#include "engine/model/lanes.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

using HalfFloats = float __attribute__((vector_size(vector_bytes / 2)));

struct Wide {
  Doubles low, high; // of the first and of the last half of the lanes
};

inline Wide operator+(const Wide &a, const Wide &b) { return {a.low + b.low, a.high + b.high}; }
inline Wide operator-(const Wide &a, const Wide &b) { return {a.low - b.low, a.high - b.high}; }
inline Wide operator*(const Wide &a, const Wide &b) { return {a.low * b.low, a.high * b.high}; }
inline Wide operator/(const Wide &a, const Wide &b) { return {a.low / b.low, a.high / b.high}; }
inline Wide operator+(const Wide &a, double b) { return {a.low + b, a.high + b}; }
inline Wide operator-(const Wide &a, double b) { return {a.low - b, a.high - b}; }
inline Wide operator*(const Wide &a, double b) { return {a.low * b, a.high * b}; }

inline Wide load_wide(const double *from) {
  return {load<Doubles>(from), load<Doubles>(from + double_lanes)};
}

inline Wide wide(const Floats &v) {
#if defined(__AVX512F__)
  const auto all = reinterpret_cast<__m512>(v);
  const __m256 low = _mm512_maskz_extractf32x8_ps(0xff, all, 0),
               high = _mm512_maskz_extractf32x8_ps(0xff, all, 1);
  return {reinterpret_cast<Doubles>(_mm512_maskz_cvtps_pd(0xff, low)),
          reinterpret_cast<Doubles>(_mm512_maskz_cvtps_pd(0xff, high))};
#else
  HalfFloats halves[2];
  std::memcpy(halves, &v, sizeof(v));
  return {__builtin_convertvector(halves[0], Doubles), __builtin_convertvector(halves[1], Doubles)};
#endif
}

inline Floats narrow(const Wide &v) {
#if defined(__AVX512F__)
  const __m256 low = _mm512_maskz_cvtpd_ps(0xff, reinterpret_cast<__m512d>(v.low)),
               high = _mm512_maskz_cvtpd_ps(0xff, reinterpret_cast<__m512d>(v.high));
  return reinterpret_cast<Floats>(_mm512_maskz_insertf32x8(0xffff, _mm512_castps256_ps512(low), high, 1));
#else
  const HalfFloats halves[2] = {__builtin_convertvector(v.low, HalfFloats),
                                __builtin_convertvector(v.high, HalfFloats)};
  Floats result;
  std::memcpy(&result, halves, sizeof(result));
  return result;
#endif
}

inline Doubles root(const Doubles &v) {
#if defined(__AVX512F__)
  return reinterpret_cast<Doubles>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(v)));
#elif defined(__AVX2__)
  return reinterpret_cast<Doubles>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(v)));
#else
  Doubles roots;
  for (int i = 0; i < double_lanes; ++i)
    roots[i] = __builtin_sqrt(v[i]);
  return roots;
#endif
}
inline Wide root(const Wide &v) { return {root(v.low), root(v.high)}; }

// To the nearest whole number, of sizes up to 2^51: the sum has no room for more digits.
inline Wide rounded(const Wide &v) {
  constexpr double shift = 0x1.8p52;
  return (v + shift) - shift;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
