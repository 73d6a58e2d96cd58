// Philox4x32-10, a random number generator without a state: four words that follow from a counter and a key
// (J. K. Salmon and others, "Parallel random numbers: as easy as 1, 2, 3", SC 2011). GLSL and C++ both read it, and both are held
// against its known answers; electrons are counted in C++ (docs/decisions.md, "Electrons on the host").
#ifndef PMDSIM_PHILOX_H
#define PMDSIM_PHILOX_H

#include "shaders/shared/languages.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#define PMDSIM_INLINE inline
#else
#define PMDSIM_INLINE
#endif

PMDSIM_CONSTANT philox_rounds = 10;
PMDSIM_CONSTANT philox_factor_x = 0xD2511F53u;
PMDSIM_CONSTANT philox_factor_z = 0xCD9E8D57u;
PMDSIM_CONSTANT philox_key_step_x = 0x9E3779B9u;
PMDSIM_CONSTANT philox_key_step_y = 0xBB67AE85u;

// The high and the low word of a product.
PMDSIM_INLINE uvec2 philox_product(uint a, uint b) {
#ifdef __cplusplus
  const std::uint64_t product = std::uint64_t{a} * b;
  return {static_cast<uint>(product >> 32), static_cast<uint>(product)};
#else
  uint high, low;
  umulExtended(a, b, high, low);
  return uvec2(high, low);
#endif
}

PMDSIM_INLINE uvec4 philox(uvec4 counter, uvec2 key) {
  for (uint i = 0; i < philox_rounds; ++i) {
    uvec2 of_x = philox_product(philox_factor_x, counter.x), of_z = philox_product(philox_factor_z, counter.z);
    counter = uvec4(of_z.x ^ counter.y ^ key.x, of_z.y, of_x.x ^ counter.w ^ key.y, of_x.y);
    key = uvec2(key.x + philox_key_step_x, key.y + philox_key_step_y);
  }
  return counter;
}

#ifdef __cplusplus
} // namespace pmdsim::shader
#endif

#endif
