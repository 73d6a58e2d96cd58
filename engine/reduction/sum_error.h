#pragma once
// How an error of the sum over the diodes becomes one of distance and of amplitude.

#include <algorithm>
#include <vector>

namespace pmdsim {

// Errors over sum|terms| / |sum|: of distance, and of amplitude, relative.
struct SumError {
  double distance_m = 0.0, amplitude = 0.0;
};

// `re` is an error along the phase of a path from where the diodes are, `im` one across it, both over
// sum|terms|.
struct ErrorScale {
  std::vector<double> wavenumbers_rad_m;   // ascending, of all modulation frequencies
  double distance_per_re_m;                // because the sum's phase is not that path's
  double distance_per_im_m;                // at the largest wavenumber
  double max_error_m, max_amplitude_error; // bearable
  bool lambert;

  double largest_wavenumber_rad_m() const { return wavenumbers_rad_m.back(); }

  double distance_m(double re, double im) const { return distance_per_re_m * re + distance_per_im_m * im; }
  // Over what is bearable; at most 1 is good.
  double excess(double re, double im) const {
    return std::max(distance_m(re, im) / max_error_m, (re + im) / max_amplitude_error);
  }
};

} // namespace pmdsim
