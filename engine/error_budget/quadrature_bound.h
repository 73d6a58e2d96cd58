#pragma once
// What few points of a pixel may be off by, in place of all its samples: what that bound has to know.

#include "engine/view/view_bounds.h"

namespace pmdsim {

// What the short way has to know of the light.
struct LightExtent {
  VisibleBox box;             // holds all diodes, camera frame
  double pattern_slope = 0.0; // radiation_laws.h
};

// Four places of a pixel, whose ranges differ by no more, may stand in for its samples.
inline constexpr double place_spread_m = 0.1;

} // namespace pmdsim
