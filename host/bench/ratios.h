#pragma once
// Speed over speed, of what was timed in turn.

#include "host/bench/modes.h"

#include <string>
#include <vector>

namespace pmdsim {

struct Ratio {
  std::string name;
  double value;     // median speed over median speed
  Spread of_rounds; // of the ratios within each round
};

// accumulate_over_native, accumulate_over_native_series and exact_frame_over_MODE_frame, as far as both are
// there.
std::vector<Ratio> ratios_of(const SetupBench &bench);

} // namespace pmdsim
