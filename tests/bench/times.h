#pragma once
// A time that was measured more than once.

#include <algorithm>
#include <vector>

namespace pmdsim::bench {

struct Times {
  double median_ms, min_ms, max_ms;
};

// The spread of at least one time.
inline Times spread(std::vector<double> times_ms) {
  std::ranges::sort(times_ms);
  return {times_ms[times_ms.size() / 2], times_ms.front(), times_ms.back()};
}

} // namespace pmdsim::bench
