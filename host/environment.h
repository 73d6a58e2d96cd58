#pragma once
// What the environment's variables say to Vulkan's drivers.

namespace pmdsim {

// How wide lavapipe's vectors are: what its environment variables say, made safe before anything asks for
// Vulkan's devices. Mesa's cache of compiled shaders on disk does not know the width, so that a width that
// was asked for gets a cache of its own unless the user has chosen one. More than 256 bits become 256:
// Mesa 22.3 crashes where wider fragments meet an attachment.
//
// To be called before other threads begin, as it may set variables; further calls do nothing.
void settle_environment();

} // namespace pmdsim
