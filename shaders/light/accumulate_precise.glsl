// A diode's weight at a point and how much longer its path is than the reference point's, as in sum.glsl and
// radiation.glsl, in Real throughout. Only measured diagrams, which are tables of floats, are looked up in float.
#ifndef PMDSIM_ACCUMULATE_PRECISE_GLSL
#define PMDSIM_ACCUMULATE_PRECISE_GLSL

#include "shaders/light/accumulate.glsl"
#include "shaders/shared/real_elementary.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer PreciseDiodes { PreciseDiode at[]; };

// A sample's point as the group sees it.
struct PrecisePoint {
  Real3 position; // P - G, m
  Real rho;       // |P - G|, m
  Real rho2;
  Real3 normal; // turned to the lens
  Real height;  // of G over the surface's plane, m
};

ReferencePath load_point(uint i, LightRun run, out PrecisePoint point) {
  ReferencePath path = see_path(load_position(constants.position, i), run, point.position);
  point.rho = path.rho;
  point.rho2 = multiply(path.rho, path.rho);
  // Whole vectors: lavapipe has been seen to load a wrong .w alone.
  vec4 surface_hi = load_vec4(constants.surface, 2 * i), surface_lo = load_vec4(constants.surface, 2 * i + 1);
  point.normal = real3(surface_hi.xyz, surface_lo.xyz);
  // By the shorter way, as in sum.glsl.
  Real3 reference = real3(run.reference_hi.xyz, run.reference_lo.xyz);
  Real of_reference = add(real(surface_hi.w, surface_lo.w), dot3(point.normal, reference));
  point.height = high(point.rho) < length(run.reference_hi.xyz) ? negate(dot3(point.normal, point.position)) : of_reference;
  return path;
}

Real half_of(Real a) { return multiply(a, real(0.5)); }

// The way from a diode to a point, m; `twice_back` is -2 (diode - G).
Real3 way_from(PrecisePoint point, Real3 twice_back) {
  return Real3(add(point.position.x, half_of(twice_back.x)), add(point.position.y, half_of(twice_back.y)),
               add(point.position.z, half_of(twice_back.z)));
}

Real whole_power(Real x) {
  Real result = real(1.0);
  [[unroll]] for (uint n = 0; n < cosine_order; ++n)
    result = multiply(result, x);
  return result;
}

// x, or 0 where it is negative.
Real at_least_zero(Real x) { return high(x) > 0.0 ? x : real(0.0); }

// As real_power of radiation.glsl.
Real real_power(Real3 way, Real3 axis, Real order, Real along_m, Real r2) {
  Real3 across = cross3(axis, way);
  Real sine2 = real_clamp(divide(dot3(across, across), r2), 0.0, 1.0);
  Real cosine2 = high(sine2) < 0.5 ? add(real(1.0), negate(sine2)) : divide(multiply(along_m, along_m), r2);
  Real j = real_exp_of(multiply(half_of(order), real_log_of(real_clamp(cosine2, 1e-37, 1.0), sine2)));
  return high(along_m) > 0.0 ? j : real(0.0);
}

// J from a diode's table.
float measured_diagram(PrecisePoint point, GroupDiode diode, Real along_m, Real r) {
  Point rounded;
  rounded.position = high3(point.position);
  Way way = way_from(diode, rounded, high(along_m), high(r));
  return pattern_model == pattern_axial ? axial_diagram(way, diode) : diagram(way, diode);
}

Real radiation(PrecisePoint point, PreciseDiode diode, Real3 twice_back, Real r, Real r2) {
  Real3 axis = real3(diode.rounded.axis.xyz, diode.axis_rest.xyz);
  Real along_m = add(dot3(axis, point.position), negate(real(diode.rounded.axis.w, diode.axis_rest.w)));
  if (pattern_model == pattern_power)
    return whole_power(at_least_zero(divide(along_m, r)));
  if (pattern_model == pattern_axial)
    return real(measured_diagram(point, diode.rounded, along_m, r));
  Real order = real(diode.rounded.order, diode.order_rest);
  Real j = diode.rounded.order < 0.0 ? real(1.0)
                                     : real_power(way_from(point, twice_back), axis, order, along_m, r2);
  if (pattern_model == pattern_any)
    j = diode.rounded.order < -1.0 ? real(measured_diagram(point, diode.rounded, along_m, r)) : j;
  return j;
}

struct WeightAndExcess {
  Real weight, excess;
};

WeightAndExcess weight_and_excess(PrecisePoint point, PreciseDiode diode, bool reached) {
  Real3 twice_back = real3(diode.rounded.position.xyz, diode.position_rest.xyz);
  Real q = add(dot3(point.position, twice_back), real(diode.rounded.position.w, diode.position_rest.w));
  Real r2 = add(point.rho2, q);
  Real r = square_root(r2);
  Real weight = divide(real(diode.rounded.intensity, diode.intensity_rest), r2);
  if (backscatter_model != backscatter_flat) {
    Real height = add(point.height, negate(half_of(dot3(point.normal, twice_back)))); // of the diode
    Real cosine = backscatter_model == backscatter_lambert ? divide(height, r) : real(1.0);
    weight = high(height) > 0.0 ? multiply(weight, cosine) : real(0.0);
  }
  if (pattern_model != pattern_isotropic)
    weight = multiply(weight, radiation(point, diode, twice_back, r, r2));
  if (shadowed != 0)
    weight = reached ? weight : real(0.0);
  return WeightAndExcess(weight, divide(q, add(r, point.rho)));
}

// As for floats; the sum stays a pair whose rest is less than half a unit in the last place, however many runs add to it.
void add_to_plane(uint plane, uint i, float backscatter, RealComplex value) {
  bool hit = backscatter > 0.0;
  Real re = hit ? multiply(real(backscatter), value.re) : real(0.0);
  Real im = hit ? multiply(real(backscatter), value.im) : real(0.0);
  uint at = plane * constants.plane + i;
  if (is_first == 0) {
    vec4 sum = load_vec4(constants.sum, at);
    re = add(real(sum.x, sum.z), re);
    im = add(real(sum.y, sum.w), im);
  }
  store_vec4(constants.sum, at, vec4(high(re), high(im), rest(re), rest(im)));
}

#endif
