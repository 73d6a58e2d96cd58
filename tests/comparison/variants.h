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

// What this device is given, and what other devices are.
inline const std::vector<Variant> variants{
    {"", SamplePrecision::automatic, DiodeLoop::automatic},
    {", float pairs, loop", SamplePrecision::double_float, DiodeLoop::looped},
};

} // namespace pmdsim::test
