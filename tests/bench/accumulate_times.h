#pragma once
// The time of the accumulate pass of several prepared simulators, in alternation, warm.

#include "engine/simulator.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pmdsim::bench {

struct Times {
  double median_ms, min_ms, max_ms;
};

inline double accumulate_ms(const Measurement &measurement) {
  for (const PassTime &pass : measurement.passes)
    if (pass.name == "accumulate")
      return pass.ms;
  return std::nan("");
}

inline std::vector<Times> accumulate_times(std::vector<Simulator> &simulators, int rounds) {
  std::vector<std::vector<double>> times_ms(simulators.size());
  for (int round = -1; round < rounds; ++round) // the first is for warming up
    for (std::size_t i = 0; i < simulators.size(); ++i)
      if (const double ms = accumulate_ms(simulators[i].measure()); round >= 0)
        times_ms[i].push_back(ms);
  std::vector<Times> result;
  for (std::vector<double> &of_one : times_ms) {
    std::ranges::sort(of_one);
    result.push_back({of_one[of_one.size() / 2], of_one.front(), of_one.back()});
  }
  return result;
}

} // namespace pmdsim::bench
