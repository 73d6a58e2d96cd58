#pragma once
// The demodulation as a part of the sum (shaders/frame/direct_pixels.comp): for pixels of one sample that are
// depth records, and whose sources are one run.

#include "engine/light/accumulate_pass.h"

#include <memory>

namespace pmdsim {

// The most frequencies that it may have, as one straight line.
inline constexpr std::uint32_t most_direct_frequencies = 8;

// Makes SumScope::output for a scope that is complete but for it.
std::shared_ptr<const SumOutput> direct_pixels(const PassSetup &on, const SourceGroups &groups,
                                               const SumScope &scope);

// Whether each pixel's bound is asked for, or has to be held against the error asked for.
bool holds_pixels(const Modulation &modulation);

} // namespace pmdsim
