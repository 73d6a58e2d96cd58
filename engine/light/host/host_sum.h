#pragma once
// The sums of powers S_i (moment_polynomials.h) on the host, for devices that are its processor, where
// sources have measured diagrams: lavapipe looks tables up lane by lane, the processor's own vectors do it at
// once.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Whether the host knows the laws of all sources, some of which are measured, and keeps few sums a sample.
bool can_sum_on_host(const SourceGroups &groups);

// Of depth records; `shadowed`: by the bits of the only window. Leaves StripBuffers::run_sums.
Pass host_sum_pass(const PassSetup &on, const SourceGroups &groups, const ChipGrid &records, bool shadowed);

} // namespace pmdsim
