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

// An error of the phase and one of what makes the other terms, of which slopes are the first.
inline constexpr std::size_t product_count = slope_count - 1;

// The change of the angle of z, radians, by the product of two errors in their units: that of the phase of a
// diode whose return is `late`, and fault i of one whose return is `of`. Their own slopes are not in it.
double product_change(const DiodeReturn &of, std::size_t i, const DiodeReturn &late, bool are_same,
                      const std::complex<double> &z);

} // namespace pmdsim
