#pragma once
// A channel's value where there is none.

#include <limits>

namespace pmdsim::test {

inline constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

} // namespace pmdsim::test
