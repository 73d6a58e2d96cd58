#pragma once
// Where the formula itself is a step or close to it, so that float and double may rightly differ.

#include "engine/reference/reference.h"

#include <vector>

namespace pmdsim::test {

// Pixels with a sample that a diode lights at a grazing angle, or that lies at the rim of a diode's
// half-space: within 0.01 of cosine zero, where the rounding of the cosine is much of what returns.
std::vector<bool> pixels_in_grazing_light(const reference::Frame &frame, const Scene &scene,
                                          const Sensor &sensor, const Illuminator &illuminator);

} // namespace pmdsim::test
