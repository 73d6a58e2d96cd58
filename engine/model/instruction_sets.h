#pragma once
// Which instruction sets of CMakeLists.txt, for which some loops are compiled, the processor has.

#include <cstdint>

namespace pmdsim {

inline bool has_avx2() {
#ifdef __x86_64__
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("popcnt") && __builtin_cpu_supports("bmi") &&
         __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("lzcnt");
#else
  return false;
#endif
}

inline bool has_avx512() {
#ifdef __x86_64__
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

} // namespace pmdsim

// Outside of all namespaces: declares the loops of a kind, `Type name` in the namespace of each instruction
// set, and widest_name(), those for the widest vectors that the processor has, of so many bits at most.
#ifdef __x86_64__
#define PMDSIM_LOOPS_OF_EACH_SET(Type, name)                                                                 \
  namespace pmdsim::baseline {                                                                               \
  extern const Type name;                                                                                    \
  }                                                                                                          \
  namespace pmdsim::avx2 {                                                                                   \
  extern const Type name;                                                                                    \
  }                                                                                                          \
  namespace pmdsim::avx512 {                                                                                 \
  extern const Type name;                                                                                    \
  }                                                                                                          \
  namespace pmdsim {                                                                                         \
  inline const Type &widest_##name(std::uint32_t most_bits) {                                                \
    if (most_bits >= 512 && has_avx512())                                                                    \
      return avx512::name;                                                                                   \
    return most_bits >= 256 && has_avx2() ? avx2::name : baseline::name;                                     \
  }                                                                                                          \
  }
#else
#define PMDSIM_LOOPS_OF_EACH_SET(Type, name)                                                                 \
  namespace pmdsim::baseline {                                                                               \
  extern const Type name;                                                                                    \
  }                                                                                                          \
  namespace pmdsim {                                                                                         \
  inline const Type &widest_##name(std::uint32_t) { return baseline::name; }                                 \
  }
#endif
