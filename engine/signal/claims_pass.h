#pragma once
// What becomes of what the pixels of direct_pixels.h may be off by: the frame's claim, and the pixels that a
// later class sums again.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Behind the sum. Those that may be beyond what was asked for are listed in `later`, or counted where there
// is none.
Pass claims_pass(const PassSetup &on, const vulkan::Buffer *later);

} // namespace pmdsim
