#pragma once
// How wide lavapipe's vectors are: what its environment variables say, made safe.

namespace pmdsim {

// To be called before anything asks for Vulkan's devices. Mesa's cache of compiled shaders on disk does not
// know the width, so that a width that was asked for (LP_NATIVE_VECTOR_WIDTH) gets a cache of its own unless
// the user has chosen one (MESA_SHADER_CACHE_DIR). More than 256 bits become 256: Mesa 22.3 crashes where
// wider fragments meet an attachment.
void settle_vector_width();

} // namespace pmdsim
