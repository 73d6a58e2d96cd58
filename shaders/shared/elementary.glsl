// Own elementary functions, in turns: Vulkan allows its sin and cos an error of 2^-11 and its atan 4,096 units in the
// last place, which is millimetres. Coefficients: interpolation at Chebyshev nodes, in exact arithmetic; the largest
// relative error of each polynomial stands beside it.
#ifndef PMDSIM_ELEMENTARY_GLSL
#define PMDSIM_ELEMENTARY_GLSL

#include "shaders/shared/real.glsl"

// (cos, sin) of 2 pi `turns`, for |turns| <= 1/2.
vec2 unit_phasor(float turns) {
  float quarter = roundEven(4.0 * turns);
  float y = turns - 0.25 * quarter; // exact; |y| <= 1/8
  float u = y * y;
  float s = y * (6.283185307 + u * (-41.34170215 + u * (81.60520471 + u * (-76.69786635 + u * 41.47283324)))); // 5e-12
  float c = 1.0 + u * (-19.73920865 + u * (64.93931614 + u * (-85.44284467 + u * 59.22016896)));              // 7e-11
  int q = int(quarter) & 3;
  vec2 turned = (q & 1) == 0 ? vec2(c, s) : vec2(-s, c);
  return (q & 2) == 0 ? turned : -turned;
}

vec2 complex_multiply(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

// The angle of z in turns, in [-1/2, 1/2]; z is not zero.
float angle_turns(vec2 z) {
  float x = abs(z.x), y = abs(z.y);
  float larger = max(x, y), smaller = min(x, y);
  // Beyond tan(pi/8) the angle is taken from the diagonal, so that the argument stays below that.
  bool near_diagonal = smaller > 0.41421356 * larger;
  Real numerator = near_diagonal ? add(real(smaller), real(-larger)) : real(smaller);
  Real denominator = near_diagonal ? add(real(smaller), real(larger)) : real(larger);
  float t = high(divide(numerator, denominator));
  float u = t * t;
  float angle = t * (0.159154943 + u * (-0.05305160562 + u * (0.03182809684 + u * (-0.02266292012 +
                u * (0.01682240502 + u * -0.009591162656))))); // 7e-10
  angle += near_diagonal ? 0.125 : 0.0;
  angle = y > x ? 0.25 - angle : angle;
  angle = z.x < 0.0 ? 0.5 - angle : angle;
  return z.y < 0.0 ? -angle : angle;
}

// Natural logarithm of x = 1 - s, given both so that neither end loses digits; x in [1e-37, 1].
float log_of(float x, float s) {
  bool near_one = x > 0.5;
  int exponent = near_one ? 0 : int(floatBitsToUint(x * 1.4142135) >> 23) - 127; // x / 2^exponent in [0.71, 1.42)
  float m = uintBitsToFloat(floatBitsToUint(x) - uint(exponent << 23));
  float y = (near_one ? -s : m - 1.0) / (m + 1.0);
  float u = y * y;
  float log_m = y * (2.0 + u * (0.6666667903 + u * (0.3999871125 + u * (0.2862020741 + u * (0.2139856051 +
                u * 0.2439390808))))); // 1e-10
  return log_m + float(exponent) * 0.69314718;
}

// e^x for x <= 0; 0 below 2^-126.
float exp_of(float x) {
  x = max(x, -128.0); // further down the polynomial would overflow, and infinity times 0 is no number
  float k = max(roundEven(x * 1.44269504), -127.0);
  float f = (x - k * 0.693359375) + k * 2.12194440e-4; // x - k ln 2, ln 2 in two parts (Cody and Waite)
  float p = 1.0 + f * (1.0 + f * (0.5 + f * (0.1666641551 + f * (0.0416663529 + f * (0.008375126398 +
            f * 0.001394110843))))); // 3e-9
  return p * (k < -126.0 ? 0.0 : uintBitsToFloat(uint(int(k) + 127) << 23));
}

#endif
