#pragma once
// What is wrong with a lens whose image would have places without a ray, for people.

#include "engine/lens.h"

#include <string>

namespace pmdsim {

// What a sensor with this fault is expected to be.
std::string expectation(LensFault fault, const Sensor &sensor);

} // namespace pmdsim
