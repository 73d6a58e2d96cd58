#pragma once
// Philox4x32-10 (shaders/shared/philox.h) in vectors: a counter for each lane.

#include "engine/model/wide_lanes.h"
#include "shaders/shared/philox.h"

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// Words of 32 bits, without a sign whatever the type says.
struct Words4 {
  Ints of[4];
};

#if defined(__AVX512F__) || defined(__AVX2__)

// Half of a vector's counters, each word in 64 bits whose upper half does not count, as products take and
// leave them.
struct PhiloxHalf {
  Longs x, y, z, w;
};

inline Longs product(const Longs &a, std::uint32_t b) {
#if defined(__AVX512F__)
  return reinterpret_cast<Longs>(
      _mm512_maskz_mul_epu32(0xff, reinterpret_cast<__m512i>(a), _mm512_set1_epi64(b)));
#else
  return reinterpret_cast<Longs>(_mm256_mul_epu32(reinterpret_cast<__m256i>(a), _mm256_set1_epi64x(b)));
#endif
}

inline Longs upper(const Longs &v) {
  using Unsigned = std::uint64_t __attribute__((vector_size(vector_bytes)));
  return reinterpret_cast<Longs>(reinterpret_cast<Unsigned>(v) >> 32);
}

inline PhiloxHalf philox_round(const PhiloxHalf &from, std::uint32_t key_x, std::uint32_t key_y) {
  const Longs of_x = product(from.x, shader::philox_factor_x),
              of_z = product(from.z, shader::philox_factor_z);
  return {upper(of_z) ^ from.y ^ std::int64_t{key_x}, of_z, upper(of_x) ^ from.w ^ std::int64_t{key_y}, of_x};
}

// `counter` of each lane: its pixel, and the three words that all lanes share.
inline Words4 philox(const Ints &pixel, const std::uint32_t (&shared)[3], const std::uint32_t (&key)[2]) {
  const auto all_longs = [](std::uint32_t word) { return Longs{} + std::int64_t{word}; };
  const Longs y = all_longs(shared[0]), z = all_longs(shared[1]), w = all_longs(shared[2]);
  PhiloxHalf even{reinterpret_cast<Longs>(pixel), y, z, w},
      odd{upper(reinterpret_cast<Longs>(pixel)), y, z, w};
  std::uint32_t key_x = key[0], key_y = key[1];
#pragma GCC unroll 10
  for (std::uint32_t i = 0; i < shader::philox_rounds; ++i) {
    even = philox_round(even, key_x, key_y);
    odd = philox_round(odd, key_x, key_y);
    key_x += shader::philox_key_step_x;
    key_y += shader::philox_key_step_y;
  }
  const auto joined = [](const Longs &a, const Longs &b) {
    return reinterpret_cast<Ints>((a & 0xffffffff) | b << 32);
  };
  return {{joined(even.x, odd.x), joined(even.y, odd.y), joined(even.z, odd.z), joined(even.w, odd.w)}};
}

#else

inline Words4 philox(const Ints &pixel, const std::uint32_t (&shared)[3], const std::uint32_t (&key)[2]) {
  Words4 words;
  for (int lane = 0; lane < lanes; ++lane) {
    const shader::uvec4 of_lane = shader::philox(
        {static_cast<std::uint32_t>(pixel[lane]), shared[0], shared[1], shared[2]}, {key[0], key[1]});
    for (int i = 0; i < 4; ++i)
      words.of[i][lane] = static_cast<std::int32_t>(of_lane[i]);
  }
  return words;
}

#endif

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
