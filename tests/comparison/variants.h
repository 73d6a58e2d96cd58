#pragma once
// The forms of the shaders that are compared with the reference.

#include "engine/model/simulator_options.h"

#include <string>
#include <vector>

namespace pmdsim::test {

struct Variant {
  std::string name;
  SamplePrecision precision;
  DiodeLoop loop;
};

// The variant that this device is given, and the one that other devices are given.
inline const std::vector<Variant> variants{
    {"", SamplePrecision::automatic, DiodeLoop::automatic},
    {", float pairs, loop", SamplePrecision::double_float, DiodeLoop::looped},
};

} // namespace pmdsim::test
