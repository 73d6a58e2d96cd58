#pragma once
// Blocks of vectors. Each step is made for all vectors of a block before the next one, so that the processor
// has work while a vector waits for its own last step: the electrons of a pixel are one long chain of steps.

#include "engine/model/elementary_lanes.h"

#include <cstddef>
#include <type_traits>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

// What is not inlined is handed over by memory, which costs more than what it does.
#define PMDSIM_INLINED [[gnu::always_inline]] inline

constexpr int block_vectors = 3; // measured: docs/decisions.md, "Electrons on the host"
constexpr int block_lanes = block_vectors * lanes;

template <class V>
struct Block {
  V of[block_vectors];
};
using FloatBlock = Block<Floats>;
using IntBlock = Block<Ints>;

// step(0), step(1), ... as a block. Not by a loop: compilers keep in memory what loops go over.
static_assert(block_vectors == 3);
template <class F>
PMDSIM_INLINED auto block_of(const F &step) {
  return Block<decltype(step(0))>{{step(0), step(1), step(2)}};
}
template <class F>
PMDSIM_INLINED void each_vector(const F &step) {
  step(0), step(1), step(2);
}

// The block of step(vector of each of `blocks`).
template <class F, class... Blocks>
PMDSIM_INLINED auto each(const F &step, const Blocks &...blocks) {
  return block_of([&](int i) __attribute__((always_inline)) { return step(blocks.of[i]...); });
}

// Operators of two blocks, or of a block and a number.
#define PMDSIM_OF_BLOCKS(op)                                                                                 \
  template <class V>                                                                                         \
  PMDSIM_INLINED auto operator op(const Block<V> &a, const Block<V> &b) {                                    \
    return each([](const V &x, const V &y) { return x op y; }, a, b);                                        \
  }                                                                                                          \
  template <class V, class T>                                                                                \
  requires std::is_arithmetic_v<T> PMDSIM_INLINED auto operator op(const Block<V> &a, T b) {                 \
    return each([b](const V &x) { return x op b; }, a);                                                      \
  }                                                                                                          \
  template <class V, class T>                                                                                \
  requires std::is_arithmetic_v<T> PMDSIM_INLINED auto operator op(T a, const Block<V> &b) {                 \
    return each([a](const V &y) { return a op y; }, b);                                                      \
  }
PMDSIM_OF_BLOCKS(+)
PMDSIM_OF_BLOCKS(-)
PMDSIM_OF_BLOCKS(*)
PMDSIM_OF_BLOCKS(/)
PMDSIM_OF_BLOCKS(&)
PMDSIM_OF_BLOCKS(|)
PMDSIM_OF_BLOCKS(^)
PMDSIM_OF_BLOCKS(<<)
PMDSIM_OF_BLOCKS(>>)
PMDSIM_OF_BLOCKS(<)
PMDSIM_OF_BLOCKS(>)
#undef PMDSIM_OF_BLOCKS

template <class V>
PMDSIM_INLINED Block<V> operator-(const Block<V> &a) {
  return each([](const V &x) { return -x; }, a);
}
template <class V>
PMDSIM_INLINED Block<V> operator~(const Block<V> &a) {
  return each([](const V &x) { return ~x; }, a);
}
template <class V, class T>
PMDSIM_INLINED Block<V> &operator+=(Block<V> &a, const T &b) {
  return a = a + b;
}
template <class V, class T>
PMDSIM_INLINED Block<V> &operator-=(Block<V> &a, const T &b) {
  return a = a - b;
}
template <class V, class T>
PMDSIM_INLINED Block<V> &operator|=(Block<V> &a, const T &b) {
  return a = a | b;
}

PMDSIM_INLINED FloatBlock filled(float value) {
  return block_of([value](int) { return all(value); });
}

// `?:` of each lane.
PMDSIM_INLINED FloatBlock chosen(const IntBlock &condition, const FloatBlock &yes, const FloatBlock &no) {
  return each([](const Ints &c, const Floats &x, const Floats &y) { return c ? x : y; }, condition, yes, no);
}
PMDSIM_INLINED FloatBlock smaller(const FloatBlock &a, const FloatBlock &b) {
  return each([](const Floats &x, const Floats &y) { return smaller(x, y); }, a, b);
}
PMDSIM_INLINED FloatBlock larger(const FloatBlock &a, const FloatBlock &b) {
  return each([](const Floats &x, const Floats &y) { return larger(x, y); }, a, b);
}
PMDSIM_INLINED FloatBlock absolute(const FloatBlock &a) {
  return each([](const Floats &x) { return absolute(x); }, a);
}
PMDSIM_INLINED FloatBlock rounded(const FloatBlock &a) {
  constexpr float shift = 0x1.8p23f; // as of one vector
  return (a + shift) - shift;
}

PMDSIM_INLINED IntBlock bits_of_floats(const FloatBlock &a) {
  return each([](const Floats &x) { return reinterpret_cast<Ints>(x); }, a);
}
PMDSIM_INLINED FloatBlock floats_of_bits(const IntBlock &a) {
  return each([](const Ints &x) { return reinterpret_cast<Floats>(x); }, a);
}
PMDSIM_INLINED FloatBlock converted(const IntBlock &a) {
  return each([](const Ints &x) { return __builtin_convertvector(x, Floats); }, a);
}
// Without a sign.
PMDSIM_INLINED IntBlock shifted_right(const IntBlock &a, int bits) {
  using Unsigned = std::uint32_t __attribute__((vector_size(vector_bytes)));
  return each([bits](const Ints &x) { return reinterpret_cast<Ints>(reinterpret_cast<Unsigned>(x) >> bits); },
              a);
}

struct FloatBlockPair {
  FloatBlock first, second;
};

// The first and the second values of pairs that lie one behind the other.
PMDSIM_INLINED FloatBlockPair pairs_apart(const float *pairs) {
  FloatBlockPair apart;
  each_vector([&](int i) {
    pairs_apart(pairs + std::ptrdiff_t{2} * lanes * i, apart.first.of[i], apart.second.of[i]);
  });
  return apart;
}

// Whether any lane is.
PMDSIM_INLINED bool is_any_below(const FloatBlock &a, float limit) {
  std::uint32_t any = 0;
  each_vector([&](int i) { any |= bits_of(less(a.of[i], all(limit))); });
  return any != 0;
}
PMDSIM_INLINED bool is_any_above(const FloatBlock &a, float limit) {
  std::uint32_t any = 0;
  each_vector([&](int i) { any |= bits_of(less(all(limit), a.of[i])); });
  return any != 0;
}
// Whether all lanes are; a lane that is no number is not.
PMDSIM_INLINED bool are_all_above(const FloatBlock &a, float limit) {
  constexpr std::uint32_t all_lanes = (1u << lanes) - 1u;
  std::uint32_t above = all_lanes;
  each_vector([&](int i) { above &= bits_of(less(all(limit), a.of[i])); });
  return above == all_lanes;
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
