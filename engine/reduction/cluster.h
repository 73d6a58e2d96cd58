#pragma once
// Diodes that differ in place and intensity only, and their moments.

#include "engine/model/illuminator.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

// Errors over sum|terms| / |sum|: of distance, and of amplitude, relative.
struct SumError {
  double distance_m = 0.0, amplitude = 0.0;
};

// How an error of the sum over the diodes becomes one of distance and of amplitude. `re` is an error along
// the phase of a path from where the diodes are, `im` one across it, both over sum|terms|.
struct ErrorScale {
  std::vector<double> wavenumbers_rad_m;   // ascending, of all modulation frequencies
  double distance_per_re_m;                // because the sum's phase is not that path's
  double distance_per_im_m;                // at the largest wavenumber
  double max_error_m, max_amplitude_error; // bearable
  bool lambert;

  double largest_wavenumber_rad_m() const { return wavenumbers_rad_m.back(); }

  double distance_m(double re, double im) const { return distance_per_re_m * re + distance_per_im_m * im; }
  // The error over the bearable one; at most 1 is good.
  double excess(double re, double im) const {
    return std::max(distance_m(re, im) / max_error_m, (re + im) / max_amplitude_error);
  }
};

struct DiodeCluster {
  std::vector<glm::dvec3> offsets_m; // from the centre, along `axes`
  Eigen::VectorXd shares;            // of the cluster's intensity; their sum is 1
  glm::dvec3 centre_m{0.0};          // of intensity, camera frame
  glm::dmat3 axes{1.0};              // columns, orthonormal
  glm::dvec3 extents_m{0.0};         // of the offsets, at most
  double radius_m = 0.0;             // of the offsets, at most
  glm::dvec3 clearance_m{0.0};    // along `axes`: of a Lambertian surface's plane from the centre, at least
  glm::dvec3 beam{0.0, 0.0, 1.0}; // the diodes' axis
  std::optional<double> order;    // of the cosine around it; nothing: isotropic
  double beam_extent_m = 0.0;     // |beam . offset| at most

  // How much a Lambertian surface's factor varies along an axis, at most.
  double slant(int axis) const { return clearance_m[axis] > 0.0 ? extents_m[axis] / clearance_m[axis] : 0.0; }
};

// The powers of `base` from 0 to `degree`.
std::vector<double> powers_of(double base, int degree);

DiodeCluster cluster_of(const std::vector<Diode> &diodes, std::span<const std::size_t> members);

// A moment: the sum over the diodes of these powers of |I|^2, the coordinates of I and a.I, each over its
// extent; I the offset, a the beam.
using Powers = std::array<std::uint8_t, 5>;

// The parts of diodes at some offsets (columns) in the cluster's moments (rows), for a share of 1 each.
Eigen::MatrixXd moment_values(const std::vector<Powers> &moments, const DiodeCluster &cluster,
                              std::span<const glm::dvec3> offsets_m);

// The moments of all the cluster's diodes.
Eigen::VectorXd moments_of(const DiodeCluster &cluster, const std::vector<Powers> &moments);

} // namespace pmdsim
