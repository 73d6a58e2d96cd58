#pragma once
// The time of passes that the host makes.

#include "engine/model/measurement.h"

#include <algorithm>
#include <chrono>

namespace pmdsim {

class Stopwatch {
public:
  // Adds the time since it was made, or last read, to a frame's.
  void add_to(Measurement &measurement, const char *pass) {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    const auto known = std::ranges::find(measurement.passes, pass, &PassTime::name);
    if (known == measurement.passes.end())
      measurement.passes.push_back({pass, ms});
    else
      known->ms += ms;
    measurement.frame_ms += ms;
    start_ = now;
  }

private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace pmdsim
