// `Real`: numbers of at least 48 bits, for what is done once a sample. A double where the device has them; with
// REAL_DOUBLE_FLOAT an unevaluated sum of two floats (Dekker, "A floating-point technique for extending the available
// precision", 1971). One set of functions, so that the code that uses it is the same for both.
#ifndef PMDSIM_REAL_GLSL
#define PMDSIM_REAL_GLSL

#ifdef REAL_DOUBLE_FLOAT

#define Real vec2

// The exact sum and product of two floats. fma() need not be fused, so the product goes by Dekker's split.
vec2 two_sum(float a, float b) {
  precise float s = a + b;
  precise float v = s - a;
  precise float rest = (a - (s - v)) + (b - v);
  return vec2(s, rest);
}
vec2 quick_two_sum(float a, float b) {
  precise float s = a + b;
  precise float rest = b - (s - a);
  return vec2(s, rest);
}
vec2 split(float a) {
  precise float t = 4097.0 * a;
  precise float upper = t - (t - a);
  precise float lower = a - upper;
  return vec2(upper, lower);
}
vec2 two_product(float a, float b) {
  precise float p = a * b;
  vec2 x = split(a), y = split(b);
  precise float rest = ((x.x * y.x - p) + x.x * y.y + x.y * y.x) + x.y * y.y;
  return vec2(p, rest);
}

Real real(float hi, float lo) { return vec2(hi, lo); }
Real real(float a) { return vec2(a, 0.0); }
float high(Real a) { return a.x; }
float rest(Real a) { return a.y; }
uvec2 words_of(Real a) { return floatBitsToUint(a); }
Real real_of(uvec2 words) { return uintBitsToFloat(words); }
Real add(Real a, Real b) {
  vec2 s = two_sum(a.x, b.x), t = two_sum(a.y, b.y);
  precise float carry = s.y + t.x;
  s = quick_two_sum(s.x, carry);
  precise float last = s.y + t.y;
  return quick_two_sum(s.x, last);
}
Real negate(Real a) { return -a; }
Real multiply(Real a, Real b) {
  vec2 p = two_product(a.x, b.x);
  precise float cross = p.y + (a.x * b.y + a.y * b.x);
  return quick_two_sum(p.x, cross);
}
Real divide(Real a, Real b) {
  // Two corrections, each of which gains a float's bits, whatever the error of the device's division.
  float q = a.x / b.x;
  Real r = add(a, negate(multiply(b, real(q))));
  float q2 = r.x / b.x;
  r = add(r, negate(multiply(b, real(q2))));
  return add(quick_two_sum(q, q2), real(r.x / b.x));
}
Real square_root(Real a) {
  float s = sqrt(a.x);
  if (s == 0.0)
    return real(0.0);
  // Newton twice: the first step starts from a root that a device may leave 2.5 units wrong.
  Real root = quick_two_sum(s, high(add(a, negate(two_product(s, s)))) / (2.0 * s));
  Real left = add(a, negate(multiply(root, root)));
  return add(root, real(high(left) / (2.0 * s)));
}
Real round_to_whole(Real a) {
  float hi = roundEven(a.x);
  return hi == a.x ? quick_two_sum(hi, roundEven(a.y)) : real(hi);
}
Real real_clamp(Real a, float low, float up) {
  if (!(a.x >= low)) // not a number counts as too low
    return real(low);
  return a.x > up ? real(up) : a;
}

#else

#define Real double

Real real(float hi, float lo) { return double(hi) + double(lo); }
Real real(float a) { return double(a); }
float high(Real a) { return float(a); }
float rest(Real a) { return float(a - double(float(a))); }
uvec2 words_of(Real a) { return unpackDouble2x32(a); }
Real real_of(uvec2 words) { return packDouble2x32(words); }
// Never fused, so that two shaders that ask the same get the same answer.
Real add(Real a, Real b) {
  precise double sum = a + b;
  return sum;
}
Real negate(Real a) { return -a; }
Real multiply(Real a, Real b) {
  precise double product = a * b;
  return product;
}
Real divide(Real a, Real b) { return a / b; }
Real square_root(Real a) {
  // Vulkan leaves the error of a double's sqrt open: one Newton step makes it sure.
  double s = sqrt(a);
  return s > 0.0lf ? 0.5lf * (s + a / s) : 0.0lf;
}
Real round_to_whole(Real a) { return roundEven(a); }
Real real_clamp(Real a, float low, float up) { return a >= double(low) ? min(a, double(up)) : double(low); }

#endif

struct Real3 {
  Real x, y, z;
};

Real3 real3(vec3 hi, vec3 lo) { return Real3(real(hi.x, lo.x), real(hi.y, lo.y), real(hi.z, lo.z)); }
Real dot3(Real3 a, Real3 b) { return add(add(multiply(a.x, b.x), multiply(a.y, b.y)), multiply(a.z, b.z)); }

// The sign of dot3(d, cross3(a, b)) is exactly the opposite of dot3(d, cross3(b, a))'s: nothing is fused.
Real cross_term(Real a, Real b, Real c, Real d) {
  precise Real p = multiply(a, b);
  precise Real q = multiply(c, d);
  precise Real difference = add(p, negate(q));
  return difference;
}
Real3 cross3(Real3 a, Real3 b) {
  return Real3(cross_term(a.y, b.z, a.z, b.y), cross_term(a.z, b.x, a.x, b.z), cross_term(a.x, b.y, a.y, b.x));
}
Real3 add3(Real3 a, Real3 b) { return Real3(add(a.x, b.x), add(a.y, b.y), add(a.z, b.z)); }
Real3 scale3(Real3 a, Real factor) {
  return Real3(multiply(a.x, factor), multiply(a.y, factor), multiply(a.z, factor));
}
Real3 subtract3(Real3 a, Real3 b) {
  return Real3(add(a.x, negate(b.x)), add(a.y, negate(b.y)), add(a.z, negate(b.z)));
}
Real length3(Real3 a) { return square_root(dot3(a, a)); }
vec3 high3(Real3 a) { return vec3(high(a.x), high(a.y), high(a.z)); }
vec3 rest3(Real3 a) { return vec3(rest(a.x), rest(a.y), rest(a.z)); }

// The fraction of `turns` beside whole turns, in [-1/2, 1/2].
Real real_turn_fraction(Real turns) { return add(turns, negate(round_to_whole(turns))); }
float turn_fraction(Real turns) { return high(real_turn_fraction(turns)); }

#endif
