#pragma once
// How much of a sum over the diodes a series that stands for it may leave out.

#include "engine/model/accuracy.h"

#include <algorithm>

namespace pmdsim {

// Of the sum of the weights: (kappa * e)^K / K! of the moments left out (docs/theory.md, "The sum by
// moments").
inline double largest_remainder(Precision precision) {
  return precision == Precision::fp64 ? 0x1p-45 : 0x1p-26;
}

// What the remainder may come to where kappa * e is `phase_rad`: where a wavelength is long, that much of a
// turn would be a long way, so it is no more than 16 times as much of e, too.
inline double largest_term(double phase_rad, double remainder) {
  return remainder * std::min(1.0, 16.0 * phase_rad);
}

} // namespace pmdsim
