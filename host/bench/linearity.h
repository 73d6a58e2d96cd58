#pragma once
// Whether time grows linearly with what a frame consists of.

#include <span>
#include <vector>

namespace pmdsim {

struct SizeAndTime {
  double size, ms;
};

// ms = fixed_ms + slope_ms * size, with the least squares of relative errors and no part below 0.
struct StraightLine {
  double fixed_ms = 0.0, slope_ms = 0.0;

  double at_ms(double size) const { return fixed_ms + slope_ms * size; }
};

// Of at least one point of positive size and time; one alone has no fixed part.
StraightLine straight_line(std::span<const SizeAndTime> points);

// What each point took more than the one before it, a unit of size; NaN of the first.
std::vector<double> marginal_costs_ms(std::span<const SizeAndTime> points);

} // namespace pmdsim
