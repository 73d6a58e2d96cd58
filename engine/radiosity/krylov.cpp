#include "engine/radiosity/krylov.h"

#include <Eigen/Dense>
#include <complex>

namespace pmdsim {
namespace {

using Number = std::complex<double>;
using Vector = std::vector<Phasor>;

Number to_double(const Phasor &value) {
  return {static_cast<double>(value.re), static_cast<double>(value.im)};
}
Phasor to_phasor(const Number &value) {
  return {static_cast<float>(value.real()), static_cast<float>(value.imag())};
}

Number product_of(const Vector &a, const Vector &b) { // conjugate(a) . b
  double re = 0.0, im = 0.0;                          // without the care of std::complex for infinities
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Number x = to_double(a[i]), y = to_double(b[i]);
    re += x.real() * y.real() + x.imag() * y.imag();
    im += x.real() * y.imag() - x.imag() * y.real();
  }
  return {re, im};
}

double size_of(const Vector &a) { return std::sqrt(product_of(a, a).real()); }

void add(Vector &to, const Number &factor, const Vector &from) {
  const Phasor f = to_phasor(factor);
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] += f * from[i];
}

Vector scaled(Vector a, double factor) {
  for (Phasor &value : a)
    value = static_cast<float>(factor) * value;
  return a;
}

} // namespace

KrylovSolution solve_series(const Vector &b, const std::function<Vector(const Vector &)> &product,
                            double residual, std::uint32_t most_products) {
  KrylovSolution solution{Vector(b.size()), 0, 0.0};
  const double size = size_of(b);
  if (size == 0.0)
    return solution;
  std::vector<Vector> basis{scaled(b, 1.0 / size)};
  Eigen::MatrixXcd hessenberg = Eigen::MatrixXcd::Zero(most_products + 1, most_products);
  Eigen::VectorXcd weights;
  for (std::uint32_t k = 0; k < most_products; ++k) {
    Vector next = scaled(product(basis[k]), -1.0); // of 1 - A
    add(next, 1.0, basis[k]);
    for (std::uint32_t i = 0; i <= k; ++i) {
      hessenberg(i, k) = product_of(basis[i], next);
      add(next, -hessenberg(i, k), basis[i]);
    }
    const double length = size_of(next);
    hessenberg(k + 1, k) = length;
    const Eigen::MatrixXcd projected = hessenberg.topLeftCorner(k + 2, k + 1);
    Eigen::VectorXcd right = Eigen::VectorXcd::Zero(k + 2);
    right(0) = size;
    weights = projected.householderQr().solve(right);
    solution.products = k + 1;
    solution.residual = (projected * weights - right).norm() / size;
    if (solution.residual <= residual || length <= 1e-7 * size)
      break;
    basis.push_back(scaled(std::move(next), 1.0 / length));
  }
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    add(solution.x, weights(i), basis[static_cast<std::size_t>(i)]);
  return solution;
}

} // namespace pmdsim
