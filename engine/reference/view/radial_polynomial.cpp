#include "engine/reference/view/radial_polynomial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pmdsim::reference {

namespace {

using Coefficients = std::vector<double>; // of 1, q, q^2, ...

double polynomial(const Coefficients &coefficients, double q) {
  double value = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;)
    value = value * q + coefficients[i];
  return value;
}

// The first double between `from` (where `before` holds) and `to` (where it does not) at which it does not.
template <class Predicate>
double bisect(double from, double to, const Predicate &before) {
  for (double middle = 0.5 * (from + to); middle > from && middle < to; middle = 0.5 * (from + to))
    (before(middle) ? from : to) = middle;
  return to;
}

// Where the polynomial changes its sign between 0 and `limit`, in rising order: once at most between
// neighbouring roots of its derivative.
std::vector<double> sign_changes(const Coefficients &coefficients, double limit) {
  if (coefficients.size() < 2)
    return {};
  Coefficients derivative;
  for (std::size_t i = 1; i < coefficients.size(); ++i)
    derivative.push_back(static_cast<double>(i) * coefficients[i]);
  std::vector<double> ends = sign_changes(derivative, limit);
  ends.push_back(limit);

  std::vector<double> changes;
  double from = 0.0;
  for (const double to : ends) {
    const bool positive = polynomial(coefficients, from) > 0;
    const auto before = [&](double q) { return (polynomial(coefficients, q) > 0) == positive; };
    if (!before(to))
      changes.push_back(bisect(from, to, before));
    from = to;
  }
  return changes;
}

// Of the slope g', a polynomial of q = r^2.
Coefficients slope_of(const Coefficients &coefficients) {
  Coefficients slope = coefficients;
  for (std::size_t i = 0; i < slope.size(); ++i)
    slope[i] *= static_cast<double>(2 * i + 1);
  return slope;
}

} // namespace

RadialPolynomial::RadialPolynomial(const std::vector<double> &k, double largest_radius)
    : coefficients_{1.0}, end_(largest_radius) {
  coefficients_.insert(coefficients_.end(), k.begin(), k.end());
  const auto folds = sign_changes(slope_of(coefficients_), largest_radius * largest_radius);
  if (!folds.empty())
    end_ = std::sqrt(folds.front());
}

double RadialPolynomial::value(double radius) const {
  return radius * polynomial(coefficients_, radius * radius);
}

std::optional<double> RadialPolynomial::inverse(double value) const {
  double beyond = std::min(value, end_);
  while (this->value(beyond) < value && beyond < end_)
    beyond = std::min(2.0 * beyond, end_);
  if (this->value(beyond) < value)
    return std::nullopt;
  return bisect(0.0, beyond, [&](double radius) { return this->value(radius) < value; });
}

} // namespace pmdsim::reference
