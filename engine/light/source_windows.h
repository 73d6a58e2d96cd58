#pragma once
// The diodes as the shadow pass takes them: in bundles of a word's bits, a window of bundles at a time.

#include "engine/light/source_groups.h"
#include "shaders/light/source_windows.h"

#include <span>
#include <vector>

namespace pmdsim {

// Whole runs of the accumulate pass. A run begins with a bundle of its own.
struct SourceWindow {
  std::uint32_t first_run, last_run; // the latter excluded
  std::uint32_t bundles;             // of all its runs
};

std::uint32_t bundles_per_run(const SourceGroups &groups);

// One for all runs.
SourceWindow all_runs(const SourceGroups &groups);

// The bundles of a window where the host decides visibility and sums.
inline constexpr std::uint32_t bundles_per_host_window = 128;

// As many runs each as fit so many bundles.
std::vector<SourceWindow> plan_windows(const SourceGroups &groups,
                                       std::uint32_t most_bundles = shader::bundles_per_window);

// The places of a bundle's diodes.
std::span<const SourcePosition> positions_of(const SourceWindow &window, std::uint32_t bundle,
                                             const SourceGroups &groups);

// A window's diodes, as the shaders know them.
struct WindowDiodes {
  shader::DiodeBox box; // around all
  std::vector<shader::BundleDiodes> bundles;
  std::vector<std::uint32_t> bits; // for each bundle, those that stand for a diode that shines
};

WindowDiodes diodes_of(const SourceWindow &window, const SourceGroups &groups);

} // namespace pmdsim
