// Elementary functions in `Real`, to 1e-13 or better. Taylor's series after the argument has been reduced: the first
// coefficients in Real (pairs of floats), the rest in float, where it adds less than 2^-22 of the result.
#ifndef PMDSIM_REAL_ELEMENTARY_GLSL
#define PMDSIM_REAL_ELEMENTARY_GLSL

#include "shaders/shared/elementary.glsl"
#include "shaders/shared/real.glsl"

struct RealComplex {
  Real re, im;
};

RealComplex complex_multiply(RealComplex a, RealComplex b) {
  return RealComplex(add(multiply(a.re, b.re), negate(multiply(a.im, b.im))),
                     add(multiply(a.re, b.im), multiply(a.im, b.re)));
}

// sum_k coefficients[k] x^k + tail x^4, by Horner's rule.
Real real_series(Real x, float tail, vec2 coefficients[4]) {
  Real sum = real(tail);
  [[unroll]] for (int k = 3; k >= 0; --k)
    sum = add(multiply(sum, x), real(coefficients[k].x, coefficients[k].y));
  return sum;
}

const vec2 sine_series[4] = {vec2(-0.166666672, 4.96705388e-9), vec2(0.00833333377, -4.34617203e-10),
                             vec2(-1.98412701e-4, 2.72559687e-12), vec2(2.75573188e-6, 3.79357122e-14)};
const vec2 cosine_series[4] = {vec2(-0.5, 0.0), vec2(0.0416666679, -1.24176347e-9),
                               vec2(-0.00138888892, 3.36310944e-11), vec2(2.48015876e-5, -3.40699609e-13)};

// (cos, sin) of 2 pi `turns`, for |turns| <= 1/2.
RealComplex real_unit_phasor(Real turns) {
  float quarter = roundEven(4.0 * high(turns));
  Real x = multiply(add(turns, real(-0.25 * quarter)), real(6.28318548, -1.74845553e-7)); // |x| <= pi / 4
  Real u = multiply(x, x);
  float v = high(u);
  Real s = real_series(u, -2.50521084e-8 + v * (1.60590438e-10 + v * -7.64716373e-13), sine_series);
  Real c = real_series(u, -2.75573192e-7 + v * (2.0876757e-9 + v * (-1.14707456e-11 + v * 4.77947733e-14)),
                       cosine_series);
  s = add(x, multiply(multiply(x, u), s));
  c = add(real(1.0), multiply(u, c));
  int q = int(quarter) & 3;
  RealComplex turned = RealComplex((q & 1) == 0 ? c : negate(s), (q & 1) == 0 ? s : c);
  return RealComplex((q & 2) == 0 ? turned.re : negate(turned.re), (q & 2) == 0 ? turned.im : negate(turned.im));
}

// The angle of z in turns, in [-1/2, 1/2]; z is not zero. The error of a float is so small an angle that it is its tangent.
Real real_angle_turns(RealComplex z) {
  float near = angle_turns(vec2(high(z.re), high(z.im)));
  RealComplex back = real_unit_phasor(real(-near));
  RealComplex left = complex_multiply(z, back);
  return add(real(near), multiply(divide(left.im, left.re), real(0.159154937, 6.42063824e-9)));
}

const vec2 log_series[4] = {vec2(0.666666687, -1.98682155e-8), vec2(0.400000006, -5.96046457e-9),
                            vec2(0.285714298, -1.2772424e-8), vec2(0.222222224, -1.65568459e-9)};

// Natural logarithm of x = 1 - s, given both so that neither end loses digits; x in [1e-37, 1]. log m = 2 artanh y, y =
// (m - 1) / (m + 1), |y| < 0.18.
Real real_log_of(Real x, Real s) {
  bool near_one = high(x) > 0.7;
  int exponent = near_one ? 0 : int(floatBitsToUint(high(x) * 1.4142135) >> 23) - 127;
  Real m = multiply(x, real(uintBitsToFloat(uint(127 - exponent) << 23))); // in [0.7, 1.42)
  Real y = divide(near_one ? negate(s) : add(m, real(-1.0)), add(m, real(1.0)));
  Real u = multiply(y, y);
  float v = high(u);
  float tail = 0.181818182 + v * (0.153846154 + v * (0.133333333 + v * (0.117647059 + v * 0.105263158)));
  Real log_m = multiply(y, add(real(2.0), multiply(u, real_series(u, tail, log_series))));
  return add(log_m, multiply(real(float(exponent)), real(0.693147182, -1.90465421e-9)));
}

const vec2 exp_series[4] = {vec2(0.166666672, -4.96705388e-9), vec2(0.0416666679, -1.24176347e-9),
                            vec2(0.00833333377, -4.34617203e-10), vec2(0.00138888892, -3.36310944e-11)};

// e^x for x <= 0; 0 below 2^-126, as of float.
Real real_exp_of(Real x) {
  x = real_clamp(x, -128.0, 0.0);
  float k = max(roundEven(high(x) * 1.44269504), -127.0);
  // x - k ln 2, ln 2 in two parts, the first of which is exact times k.
  Real f = add(add(x, real(-k * 0.693359375)), negate(multiply(real(k), real(-2.12194442e-4, 1.64659497e-12))));
  float v = high(f);
  float tail = 1.98412698e-4 + v * (2.48015873e-5 + v * (2.75573192e-6 + v * (2.75573192e-7 +
               v * (2.50521084e-8 + v * 2.0876757e-9))));
  Real p = add(multiply(real_series(f, tail, exp_series), f), real(0.5));
  p = add(multiply(add(multiply(p, f), real(1.0)), f), real(1.0));
  return multiply(p, real(k < -126.0 ? 0.0 : uintBitsToFloat(uint(int(k) + 127) << 23)));
}

#endif
