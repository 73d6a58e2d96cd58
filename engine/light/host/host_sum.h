#pragma once
// The moments of runs (shaders/light/moments.glsl) on the host, for devices that are its processor: for
// measured diagrams, which lavapipe looks up lane by lane and the processor's own vectors at once, and for
// samples that not all sources reach, where it leaves out sources that reach none of a vector's samples.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Whether the host knows the laws of all sources.
bool can_sum_on_host(const SourceGroups &groups);
// Whether what it leaves for the device is few sums a sample.
bool keeps_few_moments(const SourceGroups &groups);

// Sums depth records, by the bits of the only window where `scope` is shadowed. Leaves
// StripBuffers::run_moments.
Pass host_sum_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope);

} // namespace pmdsim
