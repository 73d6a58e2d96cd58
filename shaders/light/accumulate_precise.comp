#version 460
// accumulate.comp with all that a diode adds in Real: position, lengths, weights, moments and phases. For errors below
// float32's, and for returns that cancel. Only measured diagrams, which are tables of floats, are looked up in float.
#extension GL_GOOGLE_include_directive : require
#define SUM_IN_REAL
#include "shaders/light/accumulate.glsl"

layout(constant_id = constant_moments) const uint moments = 4;
layout(constant_id = constant_tones) const uint tones = 1;

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

// The way from a diode to a point, m; `twice_back` is -2 (diode - G).
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

void add_block(inout Real total[moments], PrecisePoint point, PreciseDiodes diodes, uint block, uint reached) {
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d) {
    WeightAndDifference we = weight_and_difference(point, diodes.at[block * diodes_per_block + d], (reached & 1u << d) != 0u);
    Real term = we.weight;
    total[0] = add(total[0], term);
    [[unroll]] for (uint k = 1; k < moments; ++k) {
      term = multiply(term, we.difference);
      total[k] = add(total[k], term);
    }
  }
}

// sum_k (j kappa)^k / k! * total[k], by Horner's rule.
RealComplex return_of(Real total[moments], Tone tone) {
  Real kappa = multiply(real(6.28318548, -1.74845553e-7), real(tone.turns_per_m.x, tone.turns_per_m.y));
  RealComplex z = RealComplex(real(0.0), real(0.0));
  [[unroll]] for (uint down = 0; down < moments; ++down) {
    uint k = moments - 1 - down;
    Real factor = divide(kappa, real(float(k + 1)));
    z = RealComplex(add(total[k], negate(multiply(z.im, factor))), multiply(z.re, factor));
  }
  return z;
}

void add_tone(uint t, uint i, Real total[moments], Real detour, LightRun run, float backscatter) {
  Tone tone = Tones(constants.tones).at[t];
  RealComplex turned = real_unit_phasor(real_turn_fraction(phase_turns(detour, run, tone)));
  add_to_plane(t, i, backscatter, complex_multiply(return_of(total, tone), turned));
}

void main() {
  uint i = sample_of_invocation();
  LightRun run = LightRuns(constants.run).at;
  PrecisePoint point;
  ReferencePath path = load_point(i, run, point);
  Real total[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] = real(0.0);
  PreciseDiodes diodes = PreciseDiodes(constants.diodes);
  if (straight != 0) {
    [[unroll]] for (uint block = 0; block < blocks_per_run; ++block)
      add_block(total, point, diodes, block, visibility_of_block(i, block));
  } else {
    for (uint block = 0; block < constants.blocks; ++block)
      add_block(total, point, diodes, block, visibility_of_block(i, block));
  }

  Real detour = add(path.rho, negate(path.range));
  float backscatter = load_backscatter(i);
  add_terms(i, backscatter, terms_of(high(total[0]), high(point.rho), high(point.height), run));
  for (uint t = 0; t < tones; ++t)
    add_tone(t, i, total, detour, run, backscatter);
}
