#pragma once
// The radial part of a lens distortion, and its inverse by bisection.

#include <optional>
#include <vector>

namespace pmdsim::reference {

// g(r) = r (1 + k1 r^2 + k2 r^4 + ...) from the optical axis, r = 0, to where it first stops to rise.
class RadialPolynomial {
public:
  // `largest_radius`: where the branch ends though it still rises.
  RadialPolynomial(const std::vector<double> &k, double largest_radius);

  double value(double radius) const;
  double end() const { return end_; } // the largest radius of the branch

  // The radius on the branch where g is `value` >= 0, to the last bit; nothing beyond the branch's end.
  std::optional<double> inverse(double value) const;

private:
  std::vector<double> coefficients_; // of 1, r^2, r^4, ... in g(r) / r
  double end_;
};

} // namespace pmdsim::reference
