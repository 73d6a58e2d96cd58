#pragma once
// Pixels of random setups of which no bound holds, because they stand at a step or lie in the dark.

#include "engine/reference/reference.h"
#include "tests/support/random_setups.h"

#include <vector>

namespace pmdsim::test {

// A flag for each pixel: whether some sample's diodes are decided otherwise than the reference decides them
// (the channel sample_visibility of both is asked for), or it is at a step of the formula, or its light is
// beyond a float or cancels so far that rounding shows in the reference's double.
std::vector<bool> uncertain_pixels(const RandomSetup &setup, const Measurement &measured,
                                   const reference::Frame &expected);

} // namespace pmdsim::test
