#pragma once
// The demodulation: sums a pixel's samples and makes its phase, amplitude, distance, taps and ground truth.

#include "engine/light/accumulate_pass.h"

namespace pmdsim {

// Demodulates the pixels that `groups` were summed for within `scope`. `leaves_truth`: the host finds the
// ground truth in records of depths (TruthOfRecords).
Pass demodulation_pass(const PassSetup &on, const SourceGroups &groups, const SumScope &scope,
                       bool leaves_truth = false);

// Whether one dispatch resolves all frequencies of depth records: else it would not find the terms.
bool resolves_at_once(const Modulation &modulation);

// Whether it leaves the errors that all pixels may have for claims_pass; else it settles its own.
bool leaves_errors(const Modulation &modulation, const SumScope &scope);

// The demodulation's specialization constants, for all shaders that do it; `first`: of the first frequency.
vulkan::Specialization demodulation_constants(const PassSetup &on, const SumScope &scope, bool first);

} // namespace pmdsim
