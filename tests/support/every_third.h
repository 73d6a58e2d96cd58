#pragma once
// Few of many cases, where the shaders of each take seconds to compile: the test of every day takes these,
// and one that is [long] all.

#include <cstddef>
#include <vector>

namespace pmdsim::test {

template <class Case>
std::vector<Case> every_third(const std::vector<Case> &cases) {
  std::vector<Case> few;
  for (std::size_t i = 0; i < cases.size(); i += 3)
    few.push_back(cases[i]);
  return few;
}

} // namespace pmdsim::test
