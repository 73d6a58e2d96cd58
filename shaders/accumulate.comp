#version 460
// The sum over the diodes of one group, for every sample (DESIGN: "Two ways to the sum", by moments). With the group's
// reference point G, rho = |P - G| and e = r_nm - rho, the return is
//   exp(j 2 pi (rho + r_n) / lambda) * sum_k (j kappa)^k / k! * sum_m w_m e_m^k,    kappa = 2 pi f / c,
// so the loop over the diodes holds no sine and no long path: float32 is enough for it at any range.
// STRAIGHT_LINE: one dispatch is one unrolled run of constant_blocks blocks, without a branch, so that lavapipe reads
// the diodes once for all lanes; else a loop over the blocks, which suits GPUs.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "buffers.glsl"
#include "compensated.glsl"
#include "elementary.glsl"
#include "real.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { AccumulateConstants constants; };
layout(constant_id = constant_moments) const uint moments = 4;
layout(constant_id = constant_backscatter) const uint backscatter_model = backscatter_flat;
layout(constant_id = constant_pattern) const uint pattern_model = pattern_isotropic;
layout(constant_id = constant_order) const uint power = 1;
layout(constant_id = constant_blocks) const uint unrolled_blocks = 1;
layout(constant_id = constant_first) const uint is_first = 0;

// A sample's point as the group sees it.
struct Point {
  vec3 position; // P - G, m
  float rho;     // |P - G|, m
  vec3 normal;   // turned to the lens
  float height;  // of G over the surface's plane, m
};

#include "radiation.glsl"

// w = I * J * (backscatter's cosine) / r^2 and e = r - rho, without the cancellation of a difference of two lengths.
vec2 weight_and_excess(Point point, GroupDiode diode) {
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
    weight *= radiation(point, diode, inverse_r, inverse_r2);
  return vec2(weight, q * r2 * inverse);
}

void add_block(inout float total[moments], Point point, Diodes diodes, uint first) {
  float part[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    part[k] = 0.0;
  [[unroll]] for (uint d = 0; d < diodes_per_block; ++d) {
    vec2 we = weight_and_excess(point, diodes.at[first + d]);
    float term = we.x;
    part[0] += term;
    [[unroll]] for (uint k = 1; k < moments; ++k) {
      term *= we.y;
      part[k] += term;
    }
  }
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] += part[k];
}

// sum_k (j kappa)^k / k! * total[k], by Horner's rule.
vec2 return_of(float total[moments], float kappa) {
  vec2 z = vec2(0.0);
  [[unroll]] for (uint down = 0; down < moments; ++down) {
    uint k = moments - 1 - down;
    z = vec2(total[k], 0.0) + vec2(-z.y, z.x) * (kappa / float(k + 1));
  }
  return z;
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  Real3 position = real3(load_vec3(constants.position_hi, i), load_vec3(constants.position_lo, i));
  vec4 surface = Vec4s(constants.surface).at[i];
  vec4 reference_hi = constants.reference_hi, reference_lo = constants.reference_lo;

  Real3 from_reference = subtract3(position, real3(reference_hi.xyz, reference_lo.xyz));
  Real rho = length3(from_reference);
  Point point;
  point.position = high3(from_reference);
  point.rho = high(rho);
  point.normal = surface.xyz;
  point.height = surface.w + dot(surface.xyz, reference_hi.xyz);

  float total[moments];
  [[unroll]] for (uint k = 0; k < moments; ++k)
    total[k] = 0.0;
  Diodes diodes = Diodes(constants.diodes);
#ifdef STRAIGHT_LINE
  [[unroll]] for (uint block = 0; block < unrolled_blocks; ++block)
    add_block(total, point, diodes, block * diodes_per_block);
#else
  for (uint block = 0; block < constants.blocks; ++block)
    add_block(total, point, diodes, block * diodes_per_block);
#endif

  // Samples are summed relative to twice their own range, which the resolve pass turns back.
  Real detour = add(rho, negate(length3(position)));
  float turns = turn_fraction(multiply(detour, real(reference_hi.w, reference_lo.w)));
  vec2 z = complex_multiply(return_of(total, constants.wavenumber), unit_phasor(turns));
  float backscatter = Floats(constants.backscatter).at[i];
  vec2 term = backscatter > 0.0 ? backscatter * z : vec2(0.0); // a sample that hit nothing adds nothing, not even NaN
  Vec4s sums = Vec4s(constants.sum);
  if (is_first != 0)
    sums.at[i] = vec4(term, 0.0, 0.0);
  else
    sums.at[i] = compensated_add(sums.at[i], term);
}
