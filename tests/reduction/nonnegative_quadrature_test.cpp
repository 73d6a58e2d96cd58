#include "engine/reduction/nonnegative_quadrature.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Powers 0 ... degree of `points` places from -1 to 1.
MatrixXd powers(Index degree, Index points) {
  MatrixXd values(degree + 1, points);
  for (Index k = 0; k <= degree; ++k)
    for (Index i = 0; i < points; ++i)
      values(k, i) = std::pow(-1.0 + 2.0 * static_cast<double>(i) / static_cast<double>(points - 1),
                              static_cast<double>(k));
  return values;
}

} // namespace

TEST_CASE("nonnegative least squares finds a solution that is there") {
  const MatrixXd a = powers(7, 200);
  const VectorXd b = a * VectorXd::Constant(200, 1.0 / 200);
  const VectorXd v = nonnegative_least_squares(a, b);
  CHECK(v.minCoeff() >= 0.0);
  CHECK((v.array() > 0.0).count() <= 8);
  CHECK((a * v - b).norm() < 1e-12);
}

TEST_CASE("nonnegative least squares stops at the nearest where there is no solution") {
  const MatrixXd a = MatrixXd::Identity(3, 3);
  const VectorXd v = nonnegative_least_squares(a, Eigen::Vector3d(1.0, -2.0, 3.0));
  CHECK(v == Eigen::Vector3d(1.0, 0.0, 3.0));
  CHECK(nonnegative_least_squares(a, Eigen::Vector3d::Zero()) == Eigen::Vector3d::Zero());
}

TEST_CASE("columns that depend on each other do no harm") {
  MatrixXd a(2, 6);
  a << 1, 1, 1, 2, 2, 0, //
      1, 1, 1, 2, 2, 1;
  const VectorXd v = nonnegative_least_squares(a, Eigen::Vector2d(3.0, 5.0));
  CHECK(v.minCoeff() >= 0.0);
  CHECK((a * v - Eigen::Vector2d(3.0, 5.0)).norm() < 1e-12);
}

TEST_CASE("a quadrature keeps the sums of as many combinations as are asked for") {
  const MatrixXd functions = powers(9, 500);
  const VectorXd weights = VectorXd::Constant(500, 1.0 / 500), sums = functions * weights;
  const Quadrature quadrature(functions, sums, weights);
  REQUIRE(quadrature.rank() >= 8);
  for (Index count = 1; count <= quadrature.rank(); ++count) {
    const VectorXd v = quadrature.keeping(count);
    CHECK(v.minCoeff() >= 0.0);
    CHECK((v.array() > 0.0).count() <= count);
  }
  CHECK((functions * quadrature.keeping(quadrature.rank()) - sums).norm() < 1e-2);
}
