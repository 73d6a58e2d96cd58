#pragma once
// Philox4x32-10 (shaders/shared/philox.h) in blocks of vectors: a counter for each lane.

#include "engine/electronics/blocks.h"
#include "shaders/shared/philox.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Words of 32 bits, without a sign whatever the type says.
struct Words4 {
  IntBlock of[4];
};

#if defined(__AVX512F__) || defined(__AVX2__)

// Half of a vector's counters, each word in 64 bits whose upper half does not count, as products take and
// leave them.
using LongBlock = Block<Longs>;
struct PhiloxHalf {
  LongBlock x, y, z, w;
};

PMDSIM_INLINED LongBlock product(const LongBlock &a, std::uint32_t b) {
#if defined(__AVX512F__)
  const __m512i factor = _mm512_set1_epi64(b);
  return each(
      [factor](const Longs &x) {
        return reinterpret_cast<Longs>(_mm512_maskz_mul_epu32(0xff, reinterpret_cast<__m512i>(x), factor));
      },
      a);
#else
  const __m256i factor = _mm256_set1_epi64x(b);
  return each(
      [factor](const Longs &x) {
        return reinterpret_cast<Longs>(_mm256_mul_epu32(reinterpret_cast<__m256i>(x), factor));
      },
      a);
#endif
}

PMDSIM_INLINED LongBlock upper(const LongBlock &a) {
  using Unsigned = std::uint64_t __attribute__((vector_size(vector_bytes)));
  return each([](const Longs &x) { return reinterpret_cast<Longs>(reinterpret_cast<Unsigned>(x) >> 32); }, a);
}

PMDSIM_INLINED PhiloxHalf philox_round(const PhiloxHalf &from, std::uint32_t key_x, std::uint32_t key_y) {
  const LongBlock of_x = product(from.x, shader::philox_factor_x),
                  of_z = product(from.z, shader::philox_factor_z);
  return {upper(of_z) ^ from.y ^ std::int64_t{key_x}, of_z, upper(of_x) ^ from.w ^ std::int64_t{key_y}, of_x};
}

// The first two rounds of counters that differ in their first word alone, with products of words that all
// lanes share made once.
PMDSIM_INLINED PhiloxHalf first_philox_rounds(const LongBlock &pixels, const std::uint32_t (&shared)[3],
                                              const std::uint32_t (&key)[2]) {
  const auto high = [](std::uint64_t of) { return static_cast<std::uint32_t>(of >> 32); };
  const std::uint64_t of_z = std::uint64_t{shader::philox_factor_z} * shared[1];
  const std::uint32_t x = high(of_z) ^ shared[0] ^ key[0], y = static_cast<std::uint32_t>(of_z);
  const LongBlock w = product(pixels, shader::philox_factor_x),
                  z = upper(w) ^ std::int64_t{shared[2] ^ key[1]};
  const std::uint64_t of_x = std::uint64_t{shader::philox_factor_x} * x;
  const LongBlock second_of_z = product(z, shader::philox_factor_z);
  return {upper(second_of_z) ^ std::int64_t{y ^ (key[0] + shader::philox_key_step_x)}, second_of_z,
          w ^ std::int64_t{high(of_x) ^ (key[1] + shader::philox_key_step_y)},
          LongBlock{} + std::int64_t{static_cast<std::uint32_t>(of_x)}};
}

// `counter` of each lane: its pixel, and the three words that all lanes share.
PMDSIM_INLINED Words4 philox(const IntBlock &pixel, const std::uint32_t (&shared)[3],
                             const std::uint32_t (&key)[2]) {
  const LongBlock pixels = each([](const Ints &v) { return reinterpret_cast<Longs>(v); }, pixel);
  PhiloxHalf even = first_philox_rounds(pixels, shared, key),
             odd = first_philox_rounds(upper(pixels), shared, key);
  std::uint32_t key_x = key[0], key_y = key[1];
#pragma GCC unroll 8
  for (std::uint32_t i = 2; i < shader::philox_rounds; ++i) {
    key_x += shader::philox_key_step_x;
    key_y += shader::philox_key_step_y;
    even = philox_round(even, key_x + shader::philox_key_step_x, key_y + shader::philox_key_step_y);
    odd = philox_round(odd, key_x + shader::philox_key_step_x, key_y + shader::philox_key_step_y);
  }
  const auto joined = [](const LongBlock &of_even, const LongBlock &of_odd) {
    return each(
        [](const Longs &a, const Longs &b) { return reinterpret_cast<Ints>((a & 0xffffffff) | b << 32); },
        of_even, of_odd);
  };
  return {{joined(even.x, odd.x), joined(even.y, odd.y), joined(even.z, odd.z), joined(even.w, odd.w)}};
}

#else

inline Words4 philox(const IntBlock &pixel, const std::uint32_t (&shared)[3], const std::uint32_t (&key)[2]) {
  Words4 words;
  for (int lane = 0; lane < block_lanes; ++lane) {
    const int vector = lane / lanes, within = lane % lanes;
    const auto number = static_cast<std::uint32_t>(pixel.of[vector][within]);
    const shader::uvec4 of_lane = shader::philox({number, shared[0], shared[1], shared[2]}, {key[0], key[1]});
    for (int i = 0; i < 4; ++i)
      words.of[i].of[vector][within] = static_cast<std::int32_t>(of_lane[i]);
  }
  return words;
}

#endif

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
