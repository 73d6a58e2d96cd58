// The parts that the sums in Real share: a sample's point, and a diode's weight there and how much longer its path is than the
// reference point's, both in Real.
#ifndef PMDSIM_PRECISE_SUM_GLSL
#define PMDSIM_PRECISE_SUM_GLSL

#define SUM_IN_REAL
#include "shaders/light/accumulate.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer PreciseDiodes { PreciseSource at[]; };

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

// The way from a diode to a point, m.
Real3 way_from(PrecisePoint point, Real3 twice_back) {
  return Real3(add(point.position.x, half_of(twice_back.x)), add(point.position.y, half_of(twice_back.y)),
               add(point.position.z, half_of(twice_back.z)));
}

struct WeightAndDifference {
  Real weight, difference;
};

WeightAndDifference weight_and_difference(PrecisePoint point, PreciseSource diode, bool reached) {
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
    weight = multiply(weight, radiation(point.position, way_from(point, twice_back), diode, r, r2));
  if (shadowed != 0)
    weight = reached ? weight : real(0.0);
  return WeightAndDifference(weight, divide(q, add(r, point.rho)));
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
