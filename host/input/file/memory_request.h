#pragma once
// Readers ask for memory before they take it, so that a file that grows on its way in ends in a clear error.

#include "host/input/file/input_error.h"

#include <cstdint>
#include <string_view>

namespace pmdsim {

// Throws Error (out_of_memory) at `place` where so many bytes more are not there; `what` says what for: "an
// image of 10000 x 10000".
void require_memory(std::uint64_t bytes, const AnyPlace &place, std::string_view what);

} // namespace pmdsim
