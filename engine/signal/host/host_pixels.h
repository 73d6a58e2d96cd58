#pragma once
// Channels from depth records at once (engine/signal/direct_pixels.h) on the host, for devices that are its
// processor: the sum over the sources and the demodulation, in the processor's own vectors.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// The sum and the demodulation of `groups`, of any number of runs, within a scope of depth records: summed
// beforehand where the scope is, else source by source, with the bits of the only window where it is
// shadowed. Nothing may be painted.
Pass host_pixels_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope);

} // namespace pmdsim
