#pragma once
// The resolve pass: sums a pixel's samples and makes its phase, amplitude, distance, taps and ground truth.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Of the pixels that `groups` were summed for within `scope`. `leaves_truth`: to the host, which finds it in
// records of depths (TruthOfRecords).
Pass resolve_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                  bool leaves_truth = false);

// The specialization constants of the resolve pass, for what resolves likewise; `first` of the frequencies.
vulkan::Specialization resolve_constants(const PassSetup &on, const SumScope &scope, bool first);

} // namespace pmdsim
