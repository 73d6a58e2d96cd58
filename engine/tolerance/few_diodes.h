#pragma once
// Boards of few diodes. A dead one of three leaves so much less light that the others' errors count for more,
// and elsewhere; what they do is no longer the sum of what each does alone. So every set of dead diodes is a
// board of its own here, exactly, and the errors of those that live are linear about it. Products of errors
// are of all pairs of diodes.

#include "engine/tolerance/linear_theory.h"

namespace pmdsim {

inline constexpr std::size_t most_few_diodes = 8; // 256 sets

struct FewDiodes {
  Deviation dead, all; // the board's
  // All errors together, of each point; NaN where no light returns.
  std::vector<double> deviation_m, varying_deviation_m;
};

// Sets that leave a point dark do not count for it. `between` as of linear_theory().
FewDiodes few_diodes(const LitView &view, const Tolerances &tolerances,
                     const std::function<void(double)> &between = {});

} // namespace pmdsim
