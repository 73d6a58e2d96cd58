#pragma once
// The simulator as every GPU test makes it: under the validation layer where PMDSIM_VALIDATE=1 is set.

#include "engine/simulator.h"

#include <cstdlib>
#include <string_view>

namespace pmdsim::test {

inline Simulator make_simulator(SimulatorOptions options = {}) {
  const char *validate = std::getenv("PMDSIM_VALIDATE");
  options.validate = validate && std::string_view(validate) == "1";
  return Simulator(options);
}

} // namespace pmdsim::test
