#pragma once
// The rounding of the lengths and cosines that a diode's weight is made of, counted operation by operation in
// units u: 2^-24 for float, 2^-45 for fp64 and for pairs of floats. t is the largest radius of a group over
// its range, so that r >= (1 - t) rho.

#include <algorithm>
#include <cmath>
#include <numbers>

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

// The fractional part of a power of a cosine, which are those of an axial distance over rho and of rho over r
// by logarithms: beside what the errors of these ratios become, the two logarithms' and the exponentials'.
inline double fraction_error_u(double power, double t, double least_cosine) {
  const double fraction = power - std::floor(power);
  const double logarithms = std::max(-std::log(least_cosine), t) - std::log(1.0 - t);
  return fraction > 0.0 ? fraction * (14.0 * logarithms + division_u + 2.0) + 12.0 : 0.0;
}

// The way from a source to a sample, over its length: the sample's place, the source's, their difference.
constexpr double way_error_u(double t) { return (2.0 + 2.0 * t) / (1.0 - t); }

// An axis's cross product with a way, over the way's length: the axis, then two products and a difference
// each.
constexpr double across_error_u(double t) { return way_error_u(t) + 1.0 + 2.0 * std::numbers::sqrt2; }

// half_plane_angle in shaders/light/radiation_laws.glsl, of a direction of `length` whose smaller part,
// larger part and length are off by so much: the angle is off by the smaller's error and tan(angle / 2), at
// most tan(22.5 degrees), times those of the others and of their sum, over the length, and by a division.
constexpr double half_plane_error_u(double smaller, double larger, double length, double tangent_of_half) {
  return smaller + tangent_of_half * (larger + length + 2.0) + division_u * std::numbers::sqrt2 / 2.0;
}
// The roundings of its polynomial and of what it is taken from.
constexpr double largest_octant_error_u = 2.9, largest_angle_error_u = largest_octant_error_u + 1.7 + 3.5;

// The angle to a source's axis up to `theta_rad`, and its place on an even grid; never falls with theta.
constexpr double theta_error_u(double t, double theta_rad) {
  constexpr double octant_rad = std::numbers::pi / 4.0, tangent = std::numbers::sqrt2 - 1.0;
  const double across = across_error_u(t) + (1.5 + root_u) * std::min(theta_rad, 1.0);
  const double along = along_error_u(t), length = 0.5 * squared_range_error_u(t) + root_u;
  const double place = 3.0 * theta_rad;
  // tan(theta / 2) lies below its chord.
  const double part = std::min(theta_rad / octant_rad, 1.0);
  const double near =
      half_plane_error_u(across, along, length, tangent * part) + largest_octant_error_u * part;
  if (theta_rad <= octant_rad)
    return near + place;
  return std::max(near, half_plane_error_u(along, across, length, tangent)) + largest_angle_error_u + place;
}

// The angle about it, and its place on an even grid, times sin theta.
constexpr double phi_error_u(double t) {
  const double x = way_error_u(t) + 4.0, y = across_error_u(t) + 4.0;
  const double length = across_error_u(t) + 1.5 + root_u;
  return half_plane_error_u(std::max(x, y), std::max(x, y), length, std::numbers::sqrt2 - 1.0) +
         largest_angle_error_u + 3.0 * std::numbers::pi;
}

} // namespace pmdsim
