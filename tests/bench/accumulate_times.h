#pragma once
// The time of the accumulate pass of several prepared simulators, in alternation, warm.

#include "engine/simulator.h"
#include "tests/bench/times.h"

#include <cmath>
#include <vector>

namespace pmdsim::bench {

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
  for (const std::vector<double> &of_one : times_ms)
    result.push_back(spread(of_one));
  return result;
}

} // namespace pmdsim::bench
