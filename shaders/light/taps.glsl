// The taps that a sum diode by diode adds up (docs/theory.md, "Tones, harmonics and taps").
#ifndef PMDSIM_TAPS_GLSL
#define PMDSIM_TAPS_GLSL

#include "shaders/shared/constants.h"

layout(constant_id = constant_taps) const uint taps = 4;

// The later half of an even N follows from the first.
const uint distinct_taps = taps % 2 == 0 ? taps / 2 : taps;
const uint totals = distinct_taps + 1; // of w times the difference of (C + 1) / 4 from the reference path's, and of w
const uint tap_planes = (distinct_taps + 1) / 2;

#endif
