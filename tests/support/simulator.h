#pragma once
// The simulator as every GPU test makes it: under the validation layer where PMDSIM_VALIDATE is set.

#include "engine/simulator.h"

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace pmdsim::test {

inline Simulator make_simulator(SimulatorOptions options = {}) {
  options.validation = validation_of(std::getenv("PMDSIM_VALIDATE"));
  return Simulator(options);
}

// A simulator compiles its shaders, which takes seconds: tests of every day take these cases, those that are
// [long] all.
template <class Case>
std::vector<Case> every_third(const std::vector<Case> &cases) {
  std::vector<Case> few;
  for (std::size_t i = 0; i < cases.size(); i += 3)
    few.push_back(cases[i]);
  return few;
}

} // namespace pmdsim::test
