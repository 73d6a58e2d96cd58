// The inverse of the lens's distortion (engine/model/sensor.h has its formulas): Newton's method from a table's guess. Residuals
// are taken in Real, derivatives in float, which costs a step or two more and no accuracy.
#ifndef PMDSIM_LENS_GLSL
#define PMDSIM_LENS_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/constants.h"

layout(constant_id = constant_distortion) const uint distortion = distortion_brown;
layout(constant_id = constant_dark_beyond_fold) const uint dark_beyond_fold = 0;
// Next to a fold the root is nearly double, and each step only halves the way to it.
const uint newton_steps = dark_beyond_fold != 0 ? 28 : 6;
const float root_residual = 1e-10; // of the slopes that Newton's steps have arrived at

struct Coefficients {
  Real radial[4];
  Real p1, p2;
};

Coefficients coefficients_of(LensModel lens) {
  Coefficients c;
  [[unroll]] for (uint n = 0; n < 4; ++n)
    c.radial[n] = real(lens.radial_hi[n], lens.radial_lo[n]);
  c.p1 = real(lens.tangential.x, lens.tangential.y);
  c.p2 = real(lens.tangential.z, lens.tangential.w);
  return c;
}

// 1 + c1 u + c2 u^2 + c3 u^3 + c4 u^4.
Real stretch(Coefficients c, Real u) {
  Real sum = c.radial[3];
  [[unroll]] for (int n = 2; n >= 0; --n)
    sum = add(multiply(sum, u), c.radial[n]);
  return add(multiply(sum, u), real(1.0));
}
// d/du of it.
float stretch_slope(Coefficients c, float u) {
  return high(c.radial[0]) +
         u * (2.0 * high(c.radial[1]) + u * (3.0 * high(c.radial[2]) + u * 4.0 * high(c.radial[3])));
}

Real doubled(Real a) { return add(a, a); }

// Slopes (x, y) whose distorted slopes are (xd, yd). `is_there` becomes whether they lie on the branch that begins at the
// optical axis; where not, they are no slopes.
void invert_brown(Coefficients c, Real xd, Real yd, float fold_radius, inout Real x, inout Real y, out bool is_there) {
  float residual = 0.0, least = 0.0;
  [[unroll]] for (uint step = 0; step < newton_steps; ++step) {
    Real xx = multiply(x, x), yy = multiply(y, y), xy = doubled(multiply(x, y));
    Real r2 = add(xx, yy);
    Real radial = stretch(c, r2);
    Real fx = add(multiply(x, radial), add(multiply(c.p1, xy), multiply(c.p2, add(r2, doubled(xx)))));
    Real fy = add(multiply(y, radial), add(multiply(c.p2, xy), multiply(c.p1, add(r2, doubled(yy)))));
    float dx = high(add(xd, negate(fx))), dy = high(add(yd, negate(fy)));
    float g = stretch_slope(c, high(r2)), p1 = high(c.p1), p2 = high(c.p2), u = high(x), v = high(y);
    float a = high(radial) + 2.0 * u * u * g + 2.0 * p1 * v + 6.0 * p2 * u;
    float b = 2.0 * (u * v * g + p1 * u + p2 * v);
    float d = high(radial) + 2.0 * v * v * g + 6.0 * p1 * v + 2.0 * p2 * u;
    float determinant = a * d - b * b;
    residual = abs(dx) + abs(dy);
    least = determinant;
    x = add(x, real((d * dx - b * dy) / determinant));
    y = add(y, real((a * dy - b * dx) / determinant));
  }
  float radius = sqrt(high(x) * high(x) + high(y) * high(y));
  is_there = least > 0.0 && residual <= root_residual && radius <= fold_radius;
}

// The angle whose distorted radius is `radius`.
Real invert_fisheye(Coefficients c, Real radius, Real theta) {
  [[unroll]] for (uint step = 0; step < newton_steps; ++step) {
    Real u = multiply(theta, theta);
    Real factor = stretch(c, u);
    float excess = high(add(radius, negate(multiply(theta, factor))));
    theta = add(theta, real(excess / (high(factor) + 2.0 * high(u) * stretch_slope(c, high(u)))));
  }
  return theta;
}

Real divided(Real a, float whole) { return divide(a, real(whole)); }

// Sine and cosine of an angle up to half a turn, in radians: Taylor's series of an eighth of it, doubled three times.
void sine_cosine(Real angle, out Real s, out Real c) {
  Real x = multiply(angle, real(0.125));
  Real minus_u = negate(multiply(x, x));
  s = c = real(1.0);
  [[unroll]] for (int n = 12; n >= 2; n -= 2) {
    s = add(real(1.0), divided(multiply(minus_u, s), float(n * (n + 1))));
    c = add(real(1.0), divided(multiply(minus_u, c), float(n * (n - 1))));
  }
  s = multiply(x, s);
  [[unroll]] for (int n = 0; n < 3; ++n) {
    Real sine2 = multiply(s, s);
    s = doubled(multiply(s, c));
    c = add(real(1.0), negate(doubled(sine2)));
  }
}

// The ray, unit length, of a place on the chip (camera frame). `is_there` becomes whether the place has one.
Real3 undistorted_ray(Lenses lens, Real3 place, out bool is_there) {
  Coefficients c = coefficients_of(lens.at);
  Real xd = divide(place.x, place.z), yd = divide(place.y, place.z);
  Real radius = square_root(add(multiply(xd, xd), multiply(yd, yd)));
  uint node = min(uint(high(radius) * lens.at.guesses_per_radius), lens_guesses - 1);
  Real guess = real(lens.guess[node]);
  if (distortion == distortion_brown) {
    // By tangential terms the fold is no circle: from the table's, steps could set out across it.
    if (dark_beyond_fold != 0)
      guess = multiply(guess, real(0.8));
    Real x = multiply(xd, guess), y = multiply(yd, guess);
    invert_brown(c, xd, yd, lens.at.fold_radius, x, y, is_there);
    Real factor = divide(real(1.0), square_root(add(real(1.0), add(multiply(x, x), multiply(y, y)))));
    return Real3(multiply(x, factor), multiply(y, factor), factor);
  }
  is_there = high(radius) < lens.at.fold_distorted;
  Real theta = invert_fisheye(c, radius, multiply(radius, guess)), sine, cosine;
  sine_cosine(theta, sine, cosine);
  Real across = high(radius) > 0.0 ? divide(sine, radius) : real(1.0);
  return Real3(multiply(xd, across), multiply(yd, across), cosine);
}

#endif
