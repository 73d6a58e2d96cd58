#pragma once
// What a change of diodes' weights does to the sum of their returns, by the moments of the weights.
//
// Diodes of one class (pattern and axis) at offsets I from a place G, a point at P from G, rho = |P|: r^2 =
// rho^2 (1 + x) with x = (|I|^2 - 2 P.I) / rho^2. A diode's term, relative to one at G,
//     exp(j kappa (r - rho)) (1 + x)^(-s/2) * (1 - a.I / a.P)^n * (1 - n.I / n.P),
// s = 2 + n (+ 1 for Lambert), n the order of the cosine around the axis a, the last factor Lambert's with
// the surface's normal, is a power series in |I|^2, the coordinates of I and a.I, whose coefficients have
// bounds over all visible P. So sums of terms that differ in their weights only differ by at most the bounds
// times what the moments of the weights differ by.

#include "engine/passes/sights.h"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace pmdsim {

// Diodes that differ in place and intensity only.
struct DiodeCluster {
  std::vector<glm::dvec3> offsets_m; // from the centre, along `axes`
  Eigen::VectorXd shares;            // of the cluster's intensity; their sum is 1
  glm::dvec3 centre_m{0.0};          // of intensity, camera frame
  glm::dmat3 axes{1.0};              // columns, orthonormal
  glm::dvec3 extents_m{0.0};         // of the offsets, at most
  double radius_m = 0.0;             // of the offsets, at most
  glm::dvec3 beam{0.0, 0.0, 1.0};    // the diodes' axis
  std::optional<double> order;       // of the cosine around it; nothing: isotropic
  double beam_extent_m = 0.0;        // |beam . offset| at most
};

// How an error of the sum becomes one of distance: `re` along the path from G, `im` across it, both over
// sum|terms|.
struct ErrorScale {
  double wavenumber_rad_m;  // the largest
  double distance_per_re_m; // by how far paths differ in phase from that from G
  double distance_per_im_m;
  double max_error_m, max_amplitude_error; // bearable
  bool lambert;

  double distance_m(double re, double im) const { return distance_per_re_m * re + distance_per_im_m * im; }
  // Over what is bearable; at most 1 is good.
  double excess(double re, double im) const {
    return std::max(distance_m(re, im) / max_error_m, (re + im) / max_amplitude_error);
  }
};

// Surfaces are asked to have a box this many times the cluster's in front of them. Lambert's factor then
// varies less.
constexpr double clearance_over_extent = 2.0;

// A moment: a sum over the diodes of these powers of |I|^2, the coordinates of I and a.I, each over its
// extent.
using Powers = std::array<std::uint8_t, 5>;

struct MomentBounds {
  std::vector<Powers> moments;
  Eigen::MatrixXd re, im;           // error per change of a moment (columns) in each sight (rows)
  Eigen::VectorXd rest_re, rest_im; // error by all that is not among the moments

  Eigen::VectorXd importance(const ErrorScale &scale) const; // of the moments: largest excess per change
  struct Error {
    double distance_m, amplitude;
  };
  // The largest over all sights, for moments that changed so much.
  Error error(const Eigen::VectorXd &changes, const ErrorScale &scale) const;
};

// What a diode of the cluster at each of some offsets (columns) adds to the moments (rows), for a share of 1.
Eigen::MatrixXd moment_values(const std::vector<Powers> &moments, const DiodeCluster &cluster,
                              std::span<const glm::dvec3> offsets_m);

// The moments that matter; nothing where the series converges too slowly.
std::optional<MomentBounds> moments_that_matter(const DiodeCluster &cluster, const std::vector<Sight> &sights,
                                                const ErrorScale &scale);

} // namespace pmdsim
