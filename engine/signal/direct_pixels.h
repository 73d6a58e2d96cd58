#pragma once
// The demodulation as a part of the sum (shaders/frame/direct_pixels.comp): of pixels of one sample that are
// depth records, whose sources are one run.

#include "engine/light/accumulate_pass.h"

#include <memory>

namespace pmdsim {

// Frequencies that it may have, as one straight line.
inline constexpr std::uint32_t most_direct_frequencies = 8;

// For SumScope::output, of a scope that is complete but for it.
std::shared_ptr<const SumOutput> direct_pixels(const PassSetup &on, const SourceGroups &groups,
                                               const SumScope &scope);

// Whether what each pixel may be off by is asked for, or has to be held against what was.
bool holds_pixels(const Modulation &modulation);

} // namespace pmdsim
