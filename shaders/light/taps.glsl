// The taps that a sum diode by diode adds up (docs/theory.md, "Tones, harmonics and taps").
#ifndef PMDSIM_TAPS_GLSL
#define PMDSIM_TAPS_GLSL

#include "shaders/shared/constants.h"

layout(constant_id = constant_taps) const uint taps = 4;

// Of an even N the later half follows from the first.
const uint distinct_taps = taps % 2 == 0 ? taps / 2 : taps;
const uint totals = distinct_taps + 1; // of w times what (C + 1) / 4 differs by from that of the reference path, and of w
const uint tap_planes = (distinct_taps + 1) / 2;

#endif
