#pragma once
// Vectors of the widest registers of the instruction set that a file is compiled for. Operators and `?:` work
// on them lane by lane; a comparison leaves all bits of a lane or none.

#include <cstdint>
#include <cstring>

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

#if defined(__AVX512F__)
constexpr int vector_bytes = 64;
#elif defined(__AVX2__)
constexpr int vector_bytes = 32;
#else
constexpr int vector_bytes = 16;
#endif
constexpr int lanes = vector_bytes / 4, double_lanes = vector_bytes / 8;

using Floats = float __attribute__((vector_size(vector_bytes)));
using Ints = std::int32_t __attribute__((vector_size(vector_bytes)));
using Doubles = double __attribute__((vector_size(vector_bytes)));
using Longs = std::int64_t __attribute__((vector_size(vector_bytes)));

template <class V, class T>
inline V load(const T *from) {
  V values;
  std::memcpy(&values, from, sizeof(values));
  return values;
}
template <class V, class T>
inline void store(T *to, const V &values) {
  std::memcpy(to, &values, sizeof(values));
}

// The first and the second values of pairs that lie one behind the other.
inline void pairs_apart(const float *pairs, Floats &first, Floats &second) {
#if defined(__AVX512F__)
  const __m512i even = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0),
                odd = _mm512_or_si512(even, _mm512_set1_epi32(1));
  const auto low = load<__m512>(pairs), high = load<__m512>(pairs + lanes);
  first = reinterpret_cast<Floats>(_mm512_permutex2var_ps(low, even, high));
  second = reinterpret_cast<Floats>(_mm512_permutex2var_ps(low, odd, high));
#elif defined(__AVX2__)
  const auto low = load<__m256>(pairs), high = load<__m256>(pairs + lanes);
  const auto in_order = [](const __m256 &v) {
    return reinterpret_cast<Floats>(_mm256_permute4x64_pd(reinterpret_cast<__m256d>(v), 0xd8));
  };
  first = in_order(_mm256_shuffle_ps(low, high, 0x88));
  second = in_order(_mm256_shuffle_ps(low, high, 0xdd));
#else
  for (int lane = 0; lane < lanes; ++lane) {
    first[lane] = *pairs++;
    second[lane] = *pairs++;
  }
#endif
}

inline Floats all(float value) { return value - Floats{}; }
inline Ints all(std::int32_t value) { return value - Ints{}; }

// Lanes where neither is smaller, or larger, take b.
template <class V>
inline V smaller(const V &a, const V &b) {
  return a < b ? a : b;
}
template <class V>
inline V larger(const V &a, const V &b) {
  return a > b ? a : b;
}
#if defined(__AVX512F__)
inline Floats smaller(const Floats &a, const Floats &b) {
  return reinterpret_cast<Floats>(
      _mm512_maskz_min_ps(0xffff, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
inline Floats larger(const Floats &a, const Floats &b) {
  return reinterpret_cast<Floats>(
      _mm512_maskz_max_ps(0xffff, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
}
#elif defined(__AVX2__)
inline Floats smaller(const Floats &a, const Floats &b) {
  return reinterpret_cast<Floats>(_mm256_min_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
inline Floats larger(const Floats &a, const Floats &b) {
  return reinterpret_cast<Floats>(_mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
}
#endif

// Over the lanes.
inline float least_of(const Floats &v) {
  float least = v[0];
  for (int lane = 1; lane < lanes; ++lane)
    least = v[lane] < least ? v[lane] : least;
  return least;
}
inline float most_of(const Floats &v) { return -least_of(-v); }

inline Floats absolute(const Floats &v) {
  return reinterpret_cast<Floats>(reinterpret_cast<Ints>(v) & 0x7fffffff);
}

// a b + c, rounded once where the processor can: as LLVM, and so lavapipe, has it.
inline Floats multiply_add(const Floats &a, const Floats &b, const Floats &c) {
#if defined(__AVX512F__)
  return reinterpret_cast<Floats>(
      _mm512_fmadd_ps(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), reinterpret_cast<__m512>(c)));
#elif defined(__FMA__)
  return reinterpret_cast<Floats>(
      _mm256_fmadd_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(c)));
#elif defined(__aarch64__)
  Floats sum;
  for (int i = 0; i < lanes; ++i)
    sum[i] = __builtin_fmaf(a[i], b[i], c[i]);
  return sum;
#else
  return a * b + c;
#endif
}

// 1 / v, to a relative error of 1.5e-7.
inline Floats inverse(const Floats &v) {
#if defined(__AVX512F__)
  const auto guess = reinterpret_cast<Floats>(_mm512_maskz_rcp14_ps(0xffff, reinterpret_cast<__m512>(v)));
  return multiply_add(guess, multiply_add(-guess, v, all(1.0f)), guess);
#else
  return 1.0f / v;
#endif
}

// 0, 1, 2, ...
inline Ints lane_numbers() {
  Ints numbers;
  for (int i = 0; i < lanes; ++i)
    numbers[i] = i;
  return numbers;
}

// from[at] of each lane. The masked forms do not alarm GCC 12 about the undefined vector of the others.
inline Ints gathered(const std::int32_t *from, const Ints &at) {
#if defined(__AVX512F__)
  return reinterpret_cast<Ints>(
      _mm512_mask_i32gather_epi32(__m512i{}, 0xffff, reinterpret_cast<__m512i>(at), from, 4));
#elif defined(__AVX2__)
  return reinterpret_cast<Ints>(_mm256_i32gather_epi32(from, reinterpret_cast<__m256i>(at), 4));
#else
  Ints values;
  for (int i = 0; i < lanes; ++i)
    values[i] = from[at[i]];
  return values;
#endif
}
inline Floats gathered(const float *from, const Ints &at) {
#if defined(__AVX512F__)
  return reinterpret_cast<Floats>(
      _mm512_mask_i32gather_ps(__m512{}, 0xffff, reinterpret_cast<__m512i>(at), from, 4));
#elif defined(__AVX2__)
  return reinterpret_cast<Floats>(_mm256_i32gather_ps(from, reinterpret_cast<__m256i>(at), 4));
#else
  Floats values;
  for (int i = 0; i < lanes; ++i)
    values[i] = from[at[i]];
  return values;
#endif
}

// Each lane's four floats in a row, from from[at] on.
struct Floats4 {
  Floats of[4];
};
inline Floats4 gathered4(const float *from, const Ints &at) {
#if defined(__AVX512F__)
  alignas(vector_bytes) std::int32_t place[lanes];
  store(place, at);
  asm("" : "+m"(place)); // read from memory, which is faster than from the vector lane by lane
  // The four floats of every fourth lane, from `lane` on.
  const auto rows = [&](int lane) {
    __m512 row = _mm512_castps128_ps512(_mm_loadu_ps(from + place[lane]));
    row = _mm512_insertf32x4(row, _mm_loadu_ps(from + place[lane + 4]), 1);
    row = _mm512_insertf32x4(row, _mm_loadu_ps(from + place[lane + 8]), 2);
    return _mm512_insertf32x4(row, _mm_loadu_ps(from + place[lane + 12]), 3);
  };
  const __m512 a = rows(0), b = rows(1), c = rows(2), d = rows(3);
  const __m512d ab_low = _mm512_castps_pd(_mm512_maskz_unpacklo_ps(0xffff, a, b)),
                ab_high = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(0xffff, a, b)),
                cd_low = _mm512_castps_pd(_mm512_maskz_unpacklo_ps(0xffff, c, d)),
                cd_high = _mm512_castps_pd(_mm512_maskz_unpackhi_ps(0xffff, c, d));
  return {{reinterpret_cast<Floats>(_mm512_maskz_unpacklo_pd(0xff, ab_low, cd_low)),
           reinterpret_cast<Floats>(_mm512_maskz_unpackhi_pd(0xff, ab_low, cd_low)),
           reinterpret_cast<Floats>(_mm512_maskz_unpacklo_pd(0xff, ab_high, cd_high)),
           reinterpret_cast<Floats>(_mm512_maskz_unpackhi_pd(0xff, ab_high, cd_high))}};
#else
  return {{gathered(from, at), gathered(from + 1, at), gathered(from + 2, at), gathered(from + 3, at)}};
#endif
}

// Each lane's value number `at` of both tables, whose numbers go on from the first to the second.
inline Floats picked(const Floats (&tables)[2], const Ints &at) {
#if defined(__AVX512F__)
  return reinterpret_cast<Floats>(_mm512_permutex2var_ps(reinterpret_cast<__m512>(tables[0]),
                                                         reinterpret_cast<__m512i>(at),
                                                         reinterpret_cast<__m512>(tables[1])));
#elif defined(__AVX2__)
  const __m256i lane = reinterpret_cast<__m256i>(at);
  return reinterpret_cast<Floats>(
      _mm256_blendv_ps(_mm256_permutevar8x32_ps(reinterpret_cast<__m256>(tables[0]), lane),
                       _mm256_permutevar8x32_ps(reinterpret_cast<__m256>(tables[1]), lane),
                       reinterpret_cast<__m256>(at << 28)));
#else
  Floats values;
  for (int i = 0; i < lanes; ++i)
    values[i] = tables[at[i] / lanes & 1][at[i] % lanes];
  return values;
#endif
}

// Square roots of values above 0, to a relative error of 3.3e-7, with AVX-512 2e-7.
inline Floats guessed_inverse_root(const Floats &v) {
#if defined(__AVX512F__)
  return reinterpret_cast<Floats>(_mm512_maskz_rsqrt14_ps(0xffff, reinterpret_cast<__m512>(v)));
#elif defined(__AVX2__)
  return reinterpret_cast<Floats>(_mm256_rsqrt_ps(reinterpret_cast<__m256>(v)));
#else
  Floats guess;
  for (int i = 0; i < lanes; ++i)
    guess[i] = 1.0f / __builtin_sqrtf(v[i]);
  return guess;
#endif
}
inline Floats inverse_root(const Floats &v) {
  const Floats guess = guessed_inverse_root(v);
  return guess + guess * (0.5f - 0.5f * v * guess * guess);
}
inline Floats root(const Floats &v) {
  const Floats guess = guessed_inverse_root(v), near = v * guess;
  return near + near * (0.5f - near * (0.5f * guess));
}

// A bit for each lane of a comparison.
inline std::uint32_t bits_of(const Ints &comparison) {
#if defined(__AVX512F__)
  return _mm512_movepi32_mask(reinterpret_cast<__m512i>(comparison));
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(comparison)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < lanes; ++i)
    bits |= static_cast<std::uint32_t>(comparison[i] & 1) << i;
  return bits;
#endif
}

// Some of a vector's lanes, as the processor compares and selects them.
#if defined(__AVX512F__)
struct Mask {
  __mmask16 lanes;
};
inline Mask less(const Floats &a, const Floats &b) {
  return {_mm512_cmp_ps_mask(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), _CMP_LT_OQ)};
}
inline Mask less(const Ints &a, const Ints &b) {
  return {_mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b))};
}
inline Mask operator&(Mask a, Mask b) { return {_kand_mask16(a.lanes, b.lanes)}; }
inline Mask without(Mask a, Mask b) { return {_kandn_mask16(b.lanes, a.lanes)}; }
inline std::uint32_t bits_of(Mask mask) { return _cvtmask16_u32(mask.lanes); }
inline Mask mask_of(std::uint32_t bits) { return {_cvtu32_mask16(bits)}; }
inline Ints add_where(Mask mask, const Ints &to, const Ints &amount) {
  const auto sum = reinterpret_cast<__m512i>(to);
  return reinterpret_cast<Ints>(
      _mm512_mask_add_epi32(sum, mask.lanes, sum, reinterpret_cast<__m512i>(amount)));
}
#else
struct Mask {
  Ints lanes;
};
inline Mask less(const Floats &a, const Floats &b) { return {a < b}; }
inline Mask less(const Ints &a, const Ints &b) { return {a < b}; }
inline Mask operator&(Mask a, Mask b) { return {a.lanes & b.lanes}; }
inline Mask without(Mask a, Mask b) { return {a.lanes & ~b.lanes}; }
inline std::uint32_t bits_of(Mask mask) { return bits_of(mask.lanes); }
inline Mask mask_of(std::uint32_t bits) {
  Mask mask{};
  for (int i = 0; i < lanes; ++i)
    mask.lanes[i] = -static_cast<std::int32_t>(bits >> i & 1u);
  return mask;
}
inline Ints add_where(Mask mask, const Ints &to, const Ints &amount) { return to + (mask.lanes & amount); }
#endif

// Packs some of a vector's lanes side by side into the first ones.
class Packing {
public:
  explicit Packing(std::uint32_t bits) : bits_(bits) {
#ifndef __AVX512F__
    for (int i = 0; bits != 0; bits &= bits - 1)
      order_[i++] = __builtin_ctz(bits);
#endif
  }
  int count() const { return __builtin_popcount(bits_); }

  Ints operator()(const Ints &v) const {
#if defined(__AVX512F__)
    return reinterpret_cast<Ints>(
        _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits_), reinterpret_cast<__m512i>(v)));
#elif defined(__clang__)
    Ints result;
    for (int i = 0; i < lanes; ++i)
      result[i] = v[order_[i]];
    return result;
#else
    return __builtin_shuffle(v, order_);
#endif
  }
  Floats operator()(const Floats &v) const {
    return reinterpret_cast<Floats>((*this)(reinterpret_cast<Ints>(v)));
  }

private:
  std::uint32_t bits_;
#ifndef __AVX512F__
  Ints order_{};
#endif
};

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
