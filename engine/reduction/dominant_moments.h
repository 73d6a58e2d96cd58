#pragma once
// The effect of a change of diodes' weights on the sum of their returns, by the moments of the weights.
//
// Diodes of one class (pattern and axis) at offsets I from a place G, a point at P from G, rho = |P|: r^2 =
// rho^2 (1 + x) with x = (|I|^2 - 2 P.I) / rho^2. A diode's term, relative to one at G,
//     exp(j kappa (r - rho)) (1 + x)^(-s/2) * (1 - a.I / a.P)^n * (1 - n.I / n.P),
// s = 2 + n (+ 1 for Lambert), n the order of the cosine around the axis a, the last factor Lambert's with
// the surface's normal, is a power series in |I|^2, the coordinates of I and a.I, whose coefficients have
// bounds over all visible P. So sums of terms that differ in their weights only differ by at most the bounds
// times what the moments of the weights differ by.

#include "engine/reduction/cluster.h"
#include "engine/reduction/directional_bounds.h"
#include "engine/reduction/series_samples.h"

#include <optional>
#include <vector>

namespace pmdsim {

struct MomentBounds {
  std::vector<Powers> moments;
  Eigen::MatrixXd re, im;           // error per change of a moment (columns) in each direction (rows)
  Eigen::VectorXd rest_re, rest_im; // error by all that is not among the moments

  // For a cluster worth the time, one for each direction: in place of the bounds of moments that they hold.
  std::vector<SeriesSamples> samples;

  Eigen::VectorXd importance(const ErrorScale &scale) const; // of the moments: largest excess per change
  // The largest over all directions, for moments that changed so much.
  SumError error(const Eigen::VectorXd &changes, const ErrorScale &scale) const;

private:
  // The errors for each direction by the moments' bounds alone, for changes of at most these sizes.
  std::vector<SumError> errors(const Eigen::VectorXd &sizes, const ErrorScale &scale) const;
};

// Whether the series converges fast enough to be worth a try.
bool converges(const DiodeCluster &cluster, const std::vector<DirectionalBounds> &directions,
               const ErrorScale &scale);

// The moments that matter; nothing where they are too many.
std::optional<MomentBounds> dominant_moments(const DiodeCluster &cluster,
                                             const std::vector<DirectionalBounds> &directions,
                                             const ErrorScale &scale);

} // namespace pmdsim
