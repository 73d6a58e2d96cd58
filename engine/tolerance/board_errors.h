#pragma once
// The errors of the diodes of random boards: numbers without a state, by Philox (shaders/shared/philox.h).

#include "engine/tolerance/lit_view.h"
#include "engine/tolerance/tolerances.h"

#include <array>
#include <cstdint>

namespace pmdsim {

// Which errors a board's diodes have.
using KindsOn = std::array<bool, kind_count>;

// The diode as a board has it. It follows from the seed and the numbers of board and diode alone; of kinds
// that are not on it is as it should be, and the others' errors are the same. A dead diode's intensity is 0,
// as is one that would be below.
TolerancedDiode on_board(const TolerancedDiode &diode, const Tolerances &tolerances, const KindsOn &on,
                         std::uint64_t seed, std::uint32_t board, std::uint32_t number);

} // namespace pmdsim
