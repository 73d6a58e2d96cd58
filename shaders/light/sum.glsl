// The sum over the diodes: the point of a sample as a group of diodes sees it, and a diode's weight there and how much longer
// its path is than the reference point's.
#ifndef PMDSIM_SUM_GLSL
#define PMDSIM_SUM_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/shared/elementary.glsl"
#include "shaders/shared/mean.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/constants.h"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_straight) const uint straight = 1;
layout(constant_id = constant_backscatter_model) const uint backscatter_model = backscatter_flat;
layout(constant_id = constant_pattern_model) const uint pattern_model = pattern_isotropic;
layout(constant_id = constant_cosine_order) const uint cosine_order = 1;
layout(constant_id = constant_cosine_fraction) const float cosine_fraction = 0.0;
layout(constant_id = constant_blocks_per_run) const uint blocks_per_run = 1;
layout(constant_id = constant_phased) const uint phased = 0;
layout(constant_id = constant_beam_edges) const uint beam_edges = 1;
layout(constant_id = constant_beams) const uint beams = 0;
layout(constant_id = constant_shadowed) const uint shadowed = 0;
layout(constant_id = constant_powers) const uint powers = 0;
layout(constant_id = constant_equal_weights) const uint equal_weights = 0;
layout(constant_id = constant_coplanar) const uint coplanar = 0;

// A sample's point as the group sees it.
struct Point {
  vec3 position; // P - G, m
  float rho;     // |P - G|, m
  vec3 normal;   // turned to the lens
  float height;  // of G over the surface's plane, m
};

#include "shaders/light/radiation_laws.glsl"

// w = I * J * (backscatter's cosine) / r^2 and e = r - rho, without the cancellation of a difference of two lengths.
vec2 weight_and_difference(Point point, GroupSource diode, bool reached) {
  float q = dot(point.position, diode.position.xyz) + diode.position.w; // r^2 - rho^2
  float r2 = point.rho * point.rho + q;
  float r = sqrt(r2);
  float sum = r + point.rho;
  float inverse = 1.0 / (r2 * sum);
  float inverse_r2 = sum * inverse;
  float weight = diode.intensity * inverse_r2;
  float inverse_r = r * inverse_r2;
  if (backscatter_model != backscatter_flat) {
    float height = point.height - 0.5 * dot(point.normal, diode.position.xyz); // of the diode over the surface
    weight *= backscatter_model == backscatter_lambert ? max(0.0, height * inverse_r) : (height > 0.0 ? 1.0 : 0.0);
  }
  if (pattern_model != pattern_isotropic)
    weight *= radiation(point, diode, r, inverse_r, inverse_r2);
  if (shadowed != 0)
    weight = reached ? weight : 0.0;
  return vec2(weight, q * r2 * inverse);
}

// The same by powers: the weight times r^p, p the powers of 1 / r in it, and q = r^2 - rho^2.
vec2 strength_and_detour(Point point, GroupSource diode, bool reached) {
  float q = dot(point.position.xy, diode.position.xy) + diode.position.w;
  if (coplanar == 0)
    q += point.position.z * diode.position.z;
  if (equal_weights != 0)
    return vec2(1.0, q);
  float strength = diode.intensity;
  if (backscatter_model != backscatter_flat) {
    float height = point.height - 0.5 * dot(point.normal, diode.position.xyz); // of the diode over the surface
    strength *= backscatter_model == backscatter_lambert ? max(0.0, height) : (height > 0.0 ? 1.0 : 0.0);
  }
  if (pattern_model == pattern_power)
    strength *= power_of_lengths(max(0.0, dot(diode.axis.xyz, point.position) - diode.axis.w), point.rho);
  else if (pattern_model != pattern_isotropic) {
    float r2 = point.rho * point.rho + q, inverse_r2 = 1.0 / r2, r = sqrt(r2);
    strength *= radiation(point, diode, r, r * inverse_r2, inverse_r2);
  }
  if (shadowed != 0)
    strength = reached ? strength : 0.0;
  return vec2(strength, q);
}

// The paths from a sample over the reference point, in double.
struct ReferencePath {
  Real range; // sample - lens, m
  Real rho;   // sample - reference point, m
};

// `from_reference`: P - G.
ReferencePath see_path(Real3 position, LightRun run, out Real3 from_reference) {
  from_reference = subtract3(position, real3(run.reference_hi.xyz, run.reference_lo.xyz));
  return ReferencePath(length3(position), length3(from_reference));
}

// `surface` as in PointsConstants.
ReferencePath see_point(Real3 position, vec4 surface, LightRun run, out Point point) {
  Real3 from_reference;
  ReferencePath path = see_path(position, run, from_reference);
  point.position = high3(from_reference);
  point.rho = high(path.rho);
  point.normal = surface.xyz;
  // By the way that is shorter, which cancels less: over the lens's height, or from the sample.
  point.height = point.rho < length(run.reference_hi.xyz) ? -dot(surface.xyz, point.position)
                                                          : surface.w + dot(surface.xyz, run.reference_hi.xyz);
  return path;
}

// The largest cosine between a run's light and the surface's normal, where backscatter has it.
float largest_facing(float height, float inverse, LightRun run) {
  return backscatter_model == backscatter_lambert ? clamp((height + run.radius_m) * inverse, 1e-6, 1.0) : 1.0;
}

// The errors that rounding makes in cosines to the diodes' axes beyond 45 degrees, as terms. In cos^n they are n / cos times as
// much as in the cosine. As x^(1 - 1 / n) is concave, the mean of cos^(n - 1) is at most W^(1 - 1 / n), W the mean of cos^n.
// Where less than 1e-4 is left of the cosine a beam ends: an edge as any other. And there is no more of it than all light comes to
// at 45 degrees. `all`: the light if each J were the largest that it has.
float beam_edge_terms(float weights, float all, LightRun run) {
  float of_weights = run.beam_edges * weights * min(pow(clamp(weights / all, 1e-37, 1.0), -run.beam_edge_root), 1e4);
  return min(of_weights, run.beam_edge_most * all);
}

// The sum of weights times the squares of their errors within beams. These grow with x = -ln J, and J times them is concave in J, so
// that the sum is at most what it would be if all J were their mean (BeamError).
float beam_terms(float weights, float all, LightRun run) {
  float x = 1e-5 - log(clamp(weights / all, 1e-37, 1.0)); // a hair more, as it is rounded
  return weights * x * (run.beams + run.beams_per_log * x);
}

// The sum of a run's terms without their phases, and what is counted apart (PixelSum): the rounding of Lambert's cosines where light
// grazes a surface, of the rims of beams and of steep diagrams; and that within beams.
vec3 terms_of(float weights, float rho, float height, LightRun run) {
  float inverse = 1.0 / (rho - run.radius_m); // half of rho at least
  float all = run.brightest * inverse * inverse * largest_facing(height, inverse, run); // where J is largest
  float terms = 0.0, of_beams = 0.0;
  if (backscatter_model == backscatter_lambert) {
    float any = run.heights * run.intensity * inverse * inverse * inverse;
    // In the dark beside a beam a height's rounding weighs no more than the light.
    float lowest = height - run.radius_m; // of the run's diodes, at least
    terms += lowest > 0.0 ? min(any, run.heights * weights / lowest) : any;
  }
  if (pattern_model == pattern_axial || pattern_model == pattern_any)
    terms += run.diagrams * inverse * inverse * largest_facing(height, inverse, run);
  if (beam_edges != 0)
    terms += beam_edge_terms(weights, all, run);
  if (beams != 0)
    of_beams = beam_terms(weights, all, run);
  return weights > 0.0 ? vec3(weights, terms, of_beams) : vec3(0.0); // where there is no light nothing can be off
}

// The light at a tone over its modulated part: at 0 Hz it is the mean.
float light_of_tone(LightRun run, Tone tone) {
  return is_mean(tone) ? run.mean_over_modulated : 1.0;
}

// The phase of a path at a tone, the illuminator's with it, in turns.
Real phase_turns(Real path_m, LightRun run, Tone tone) {
  Real turns = multiply(path_m, real(tone.turns_per_m.x, tone.turns_per_m.y));
  if (phased != 0)
    turns = add(turns, multiply(real(run.phase_turns.x, run.phase_turns.y), real(tone.harmonic)));
  return turns;
}

#endif
