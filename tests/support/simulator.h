#pragma once
// The simulator as every GPU test makes it: under the validation layer where PMDSIM_VALIDATE is set.

#include "engine/simulator.h"

#include <cstdlib>

namespace pmdsim::test {

inline Simulator make_simulator(SimulatorOptions options = {}) {
  options.validation = validation_of(std::getenv("PMDSIM_VALIDATE"));
  return Simulator(options);
}

} // namespace pmdsim::test
