#pragma once
// Few points with weights >= 0 in place of many, so that the sums of given functions over them stay the same.

#include <Eigen/Core>

namespace pmdsim {

// v >= 0 with few nonzeros and the smallest |a v - b|: Lawson and Hanson's active sets. At most as many
// nonzeros as `a` has rows.
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd &a, const Eigen::VectorXd &b);

// Functions by their importance: their most important combinations, orthonormal over the points' weights.
class Quadrature {
public:
  // functions: a row each, at the points (columns), times how much their sums matter. sums: those to be kept.
  // weights: of the points, >= 0, their sum 1; they only say which combinations are important.
  Quadrature(const Eigen::MatrixXd &functions, const Eigen::VectorXd &sums, const Eigen::VectorXd &weights);

  // How many combinations there are.
  Eigen::Index rank() const { return combinations_.rows(); }
  // Weights that keep the sums of the first `count` combinations as nearly as can be; at most `count` of them
  // are not 0.
  Eigen::VectorXd keeping(Eigen::Index count) const;

private:
  Eigen::MatrixXd combinations_; // their values at the points
  Eigen::VectorXd sums_;
};

} // namespace pmdsim
