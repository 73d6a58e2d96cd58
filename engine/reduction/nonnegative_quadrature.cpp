#include "engine/reduction/nonnegative_quadrature.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <random>
#include <vector>

namespace pmdsim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double smallest_gain = 1e-13;      // of a point's function values, relative: below it is rounding
constexpr double smallest_importance = 1e-3; // of a combination: sums are off by so much of what is bearable
constexpr Index most_combinations = 200;

// Orthonormal columns that span, but for rounding, most of what the columns of `a` span: a random mixture of
// them (Halko, Martinsson, Tropp 2011).
MatrixXd span_of(const MatrixXd &a) {
  std::mt19937 random(1);
  MatrixXd mixture(a.cols(), std::min({a.rows(), a.cols(), most_combinations}));
  for (double &entry : mixture.reshaped())
    entry = 0x1p-31 * static_cast<double>(random()) - 1.0;
  const MatrixXd mixed = a * mixture;
  return mixed.householderQr().householderQ() * MatrixXd::Identity(mixed.rows(), mixed.cols());
}

// The points in use and their weights.
class ActiveSet {
public:
  ActiveSet(const MatrixXd &a, const VectorXd &b) : a_(a), b_(b), weights_(VectorXd::Zero(a.cols())) {}

  const VectorXd &weights() const { return weights_; }
  Index size() const { return static_cast<Index>(points_.size()); }
  VectorXd residual() const {
    VectorXd left = b_;
    for (const Index point : points_)
      left -= weights_[point] * a_.col(point);
    return left;
  }

  // Takes a point in and gives all their best weights, leaving out those that would get a negative one.
  // Whether the point found a place.
  bool add(Index point) {
    points_.push_back(point);
    VectorXd best = best_weights();
    if (best[size() - 1] <= 0.0) { // only by rounding
      points_.pop_back();
      return false;
    }
    while (!points_.empty() && best.minCoeff() <= 0.0) {
      step_towards(best);
      best = best_weights();
    }
    for (Index i = 0; i < size(); ++i)
      weights_[points_[static_cast<std::size_t>(i)]] = best[i];
    return true;
  }

private:
  VectorXd best_weights() const {
    MatrixXd columns(a_.rows(), size());
    for (Index i = 0; i < size(); ++i)
      columns.col(i) = a_.col(points_[static_cast<std::size_t>(i)]);
    return columns.householderQr().solve(b_);
  }

  // As far as no weight becomes negative; those that reach 0 leave.
  void step_towards(const VectorXd &best) {
    double step = 1.0;
    Index first_out = 0;
    for (Index i = 0; i < size(); ++i) {
      const double weight = weights_[points_[static_cast<std::size_t>(i)]];
      if (best[i] <= 0.0 && weight <= step * (weight - best[i])) {
        step = weight / (weight - best[i]);
        first_out = i;
      }
    }
    for (Index i = 0; i < size(); ++i) {
      double &weight = weights_[points_[static_cast<std::size_t>(i)]];
      weight = i == first_out ? 0.0 : std::max(0.0, weight + step * (best[i] - weight));
    }
    std::erase_if(points_, [this](Index point) { return weights_[point] <= 0.0; });
  }

  const MatrixXd &a_;
  const VectorXd &b_;
  std::vector<Index> points_;
  VectorXd weights_;
};

} // namespace

VectorXd nonnegative_least_squares(const MatrixXd &a, const VectorXd &b) {
  ActiveSet active(a, b);
  const VectorXd lengths = a.colwise().norm();
  for (Index i = 0; i < 3 * a.rows() && active.size() < a.rows(); ++i) {
    const VectorXd residual = active.residual();
    VectorXd gains = a.transpose() * residual;
    const VectorXd rounding = smallest_gain * b.norm() * lengths;
    Index point = 0;
    while (gains.maxCoeff(&point) > rounding[point] && !active.add(point))
      gains[point] = 0.0;
    if (gains[point] <= rounding[point])
      break;
  }
  return active.weights();
}

Quadrature::Quadrature(const MatrixXd &functions, const VectorXd &sums, const VectorXd &weights) {
  const MatrixXd weighted = functions * weights.cwiseSqrt().asDiagonal();
  const MatrixXd span = span_of(weighted);
  const Eigen::BDCSVD<MatrixXd> svd(span.transpose() * weighted, Eigen::ComputeThinU);
  const VectorXd &importance = svd.singularValues();
  Index rank = 0;
  while (rank < importance.size() && importance[rank] > smallest_importance)
    ++rank;
  const MatrixXd combine =
      importance.head(rank).cwiseInverse().asDiagonal() * (span * svd.matrixU().leftCols(rank)).transpose();
  combinations_ = combine * functions;
  sums_ = combine * sums;
}

VectorXd Quadrature::keeping(Index count) const {
  return nonnegative_least_squares(combinations_.topRows(count), sums_.head(count));
}

} // namespace pmdsim
