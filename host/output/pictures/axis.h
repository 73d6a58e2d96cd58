#pragma once
// Where the ticks of an axis stand and what is written beside them.

#include <string>
#include <vector>

namespace pmdsim {

struct Range {
  double min = 0.0;
  double max = 1.0;
  double span() const { return max - min; }
};

struct Tick {
  double value;
  std::string label; // in units of 10^exponent of its axis
};

// Ticks at round numbers: 1, 2 or 5 times a power of ten apart.
struct Axis {
  Range range;
  int exponent = 0; // power of ten that the labels leave out, a multiple of 3; 0 for everyday numbers
  std::vector<Tick> ticks;
};

// At most `max_ticks` ticks (at least 1) within `range`, whose span is positive and finite.
Axis make_axis(const Range &range, int max_ticks);

// A logarithmic axis over positive values: `range` and the ticks' values are their decimal logarithms, the
// labels the values themselves, at powers of ten, and at 2 and 5 times these where there are few.
Axis make_log_axis(const Range &range);

// "deformation (mm)", "amplitude (10⁻³ W/(m² sr))", "coverage".
std::string axis_title(const std::string &quantity, const std::string &unit, int exponent);

} // namespace pmdsim
