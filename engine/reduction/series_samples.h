#pragma once
// The lowest powers of a direction's series (dominant_moments.h), not by bounds of each, but all together at
// many points and at each frequency: where they cancel, the bound is smaller.
//
// With tau = R / rho, R the cluster's radius, and P's direction u a coefficient is a polynomial in tau and
// u's components. A polynomial of degree n is nowhere on an interval more than 1 / cos(pi n / 2 N) times its
// largest size at N > n of Chebyshev's points (Ehlich and Zeller 1964); so in each variable.

#include "engine/reduction/cluster.h"
#include "engine/reduction/directional_bounds.h"

#include <array>
#include <complex>
#include <vector>

namespace pmdsim {

class SeriesSamples {
public:
  // least_terms: a lower bound of sum|terms|, relative to one diode at the centre.
  SeriesSamples(const DiodeCluster &cluster, const DirectionalBounds &seen, const ErrorScale &scale,
                const std::vector<Powers> &moments, double least_terms);

  // By index into `moments`: those that are in here.
  const std::vector<Eigen::Index> &held() const { return held_; }
  // The largest error over all directions, ranges and (Lambertian) slants.
  SumError largest_error(const Eigen::VectorXd &changes, const ErrorScale &scale) const;

private:
  struct Term;

  void hold(const std::vector<Powers> &moments, int degree, bool lambert);
  void set_column(Eigen::Index column, const std::vector<Term> &terms,
                  const std::vector<std::complex<double>> &of_size, const glm::dvec3 &direction, int degree);

  std::vector<Eigen::Index> held_;
  // Beside held_: the moment with one power more of each coordinate, or no_moment.
  std::array<std::vector<Eigen::Index>, 3> raised_;
  std::array<double, 3> slants_;
  Eigen::MatrixXd re_, im_;          // a row each moment held, a column each point of each frequency
  Eigen::ArrayXd distance_per_im_m_; // beside the columns
};

} // namespace pmdsim
