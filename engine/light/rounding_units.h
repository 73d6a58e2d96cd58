#pragma once
// The rounding of the lengths and cosines that a diode's weight is made of, counted operation by operation in
// units u: 2^-24 for float, 2^-45 for fp64 and for pairs of floats. t is the largest radius of a group over
// its range, so that r >= (1 - t) rho.

namespace pmdsim {

// Vulkan allows a division 2.5 units in the last place, 5 u, and a square root, an inverse one inverted, 4.5.
inline constexpr double division_u = 5.0, root_u = 9.0;
// Inverse roots of the host's loops (engine/model/lanes.h), one step of Newton's from the processor's guess.
inline constexpr double host_root_u = 5.5;

// The rounding of r^2 = rho^2 + q: |q| <= 2 rho R + R^2 takes six in its larger part, two in the other.
constexpr double squared_range_error_u(double t) {
  return 1.0 + (3.0 + 12.0 * t + 2.0 * t * t) / ((1.0 - t) * (1.0 - t));
}

// An inner product with a unit vector, `count` roundings of the length rho, as a cosine: over r.
constexpr double cosine_error_u(double count, double t) { return count / (1.0 - t); }

// The rounding of the cosine to a diode's axis.
constexpr double along_error_u(double t) { return cosine_error_u(6.0 + 2.0 * t, t); }

} // namespace pmdsim
