#pragma once
// One diode's term of eq. 5 to 7 with its slopes.

#include "engine/tolerance/demodulation.h"
#include "engine/tolerance/lit_view.h"
#include "engine/tolerance/tolerances.h"

#include <array>
#include <complex>

namespace pmdsim {

struct DiodeReturn {
  double weight = 0.0; // B I J / r^2, W/(m^2 sr)
  std::complex<double> z{};
  // Per metre, radian, share of the intensity, radian: of each fault but `dead`.
  std::array<std::complex<double>, slope_count> slope{};
};

// The diode's light by way of a point that it reaches.
DiodeReturn diode_return(const LitView &view, const Demodulation &demodulation, const LitPoint &point,
                         const TolerancedDiode &diode);

} // namespace pmdsim
