// The frequency of 0 Hz, whose sum is the mean light: it has no phase and no distance.
#ifndef PMDSIM_MEAN_GLSL
#define PMDSIM_MEAN_GLSL

#include "shaders/shared/constants.h"
#include "shaders/shared/interface.h"

layout(constant_id = constant_keeps_mean) const uint keeps_mean = 0;

bool is_mean(Frequency frequency) { return keeps_mean != 0 && frequency.ambiguity_m.x == 0.0; }
bool is_mean(Tone tone) { return keeps_mean != 0 && tone.harmonic == 0.0; }

#endif
