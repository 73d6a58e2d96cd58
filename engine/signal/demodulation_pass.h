#pragma once
// The demodulation: sums a pixel's samples and makes its phase, amplitude, distance, taps and ground truth.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Of the pixels that `groups` were summed for within `scope`. `leaves_truth`: to the host, which finds it in
// records of depths (TruthOfRecords).
Pass demodulation_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                       bool leaves_truth = false);

// The specialization constants of the demodulation, for what resolves likewise; `first` of the frequencies.
vulkan::Specialization demodulation_constants(const PassSetup &on, const SumScope &scope, bool first);

} // namespace pmdsim
