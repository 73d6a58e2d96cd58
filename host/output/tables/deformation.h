#pragma once
// Bistatic deformation: what the light beside the lens adds to the distance that light in the lens would give
// (paper, figs 11 and 13).

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

// bistatic - monostatic, wrapped to (-ambiguity/2, +ambiguity/2], in millimetres; NaN where either is NaN.
// `ambiguity_m` is c/(2f). Both spans have one length. The distances are unrounded, as a float at 2 m has
// steps of 0.24 um, which is much of a small deformation.
std::vector<double> deformation_mm(std::span<const double> bistatic_distance_m,
                                   std::span<const double> monostatic_distance_m, double ambiguity_m);

// Over the pixels that are not NaN; every figure is NaN where there is none.
struct DeformationStatistics {
  double mean_mm, min_mm, max_mm, rms_mm;
  double centre_mm;  // mean of the middle 1, 2 or 4 pixels
  double varying_mm; // root mean square of what is left when the mean is taken away, as a calibration does
};

// `deformation_mm` is row-major, rows * columns values.
DeformationStatistics statistics_of(std::span<const double> deformation_mm, const glm::uvec2 &resolution);

} // namespace pmdsim
