#pragma once
// How wide lavapipe's vectors are: what its environment variables say, made safe.

namespace pmdsim {

// To be called before anything asks for Vulkan's devices. Mesa's cache of compiled shaders on disk does not
// know the width, so that a width that was asked for (LP_NATIVE_VECTOR_WIDTH) gets a cache of its own unless
// the user has chosen one (MESA_SHADER_CACHE_DIR). With `no_wide_vectors` more than 256 bits become 256.
//
// 512 bits are not asked for by ourselves: measured on Zen 5 (BENCHMARKS.md) they halve the time of the sum
// over the diodes, but what lavapipe does lane by lane takes twice as long, and whole frames take longer.
void settle_vector_width(bool no_wide_vectors);

} // namespace pmdsim
