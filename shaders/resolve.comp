#version 460
// Phase, amplitude, distance and ground truth of each pixel from the returns of its samples, summed in a fixed order.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "buffers.glsl"
#include "compensated.glsl"
#include "elementary.glsl"
#include "real.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { ResolveConstants constants; };

float nan() { return uintBitsToFloat(0x7fc00000u); }

struct PixelSum {
  vec4 z;      // compensated, relative to twice the reference range
  Real range;  // sum over the hits, m
  Real depth;
  Real reference_m; // range of the first hit
  uint hits;
};

PixelSum sum_samples(uint pixel) {
  PixelSum sum = PixelSum(vec4(0.0), real(0.0), real(0.0), real(0.0), 0u);
  Real turns_per_m = real(constants.turns_per_m.x, constants.turns_per_m.y);
  uint count = constants.samples * constants.samples;
  for (uint s = 0; s < count; ++s) {
    uint i = s * constants.padded_pixels + pixel;
    vec3 hi = load_vec3(constants.position_hi, i);
    if (hi.z == 0.0)
      continue;
    Real3 position = real3(hi, load_vec3(constants.position_lo, i));
    Real range = length3(position);
    if (sum.hits == 0u)
      sum.reference_m = range;
    float turns = turn_fraction(multiply(add(range, negate(sum.reference_m)), turns_per_m));
    vec2 z = compensated_value(Vec4s(constants.sum).at[i]);
    sum.z = compensated_add(sum.z, complex_multiply(z, unit_phasor(turns)));
    sum.range = add(sum.range, range);
    sum.depth = add(sum.depth, position.z);
    sum.hits += 1u;
  }
  return sum;
}

void store(uint channel, uint pixel, uint word) {
  Words(constants.channels).at[channel * constants.padded_pixels + pixel] = word;
}
void store(uint channel, uint pixel, float value) { store(channel, pixel, floatBitsToUint(value)); }

// |z| without overflow or underflow of the squares.
float magnitude(vec2 z) {
  if (z == vec2(0.0))
    return 0.0;
  float larger = max(abs(z.x), abs(z.y));
  vec2 scaled = z / larger;
  return larger * sqrt(dot(scaled, scaled));
}

void store_return(uint pixel, PixelSum sum) {
  vec2 z = compensated_value(sum.z);
  float amplitude = constants.amplitude_scale * magnitude(z) / float(constants.samples * constants.samples);
  store(channel_amplitude, pixel, amplitude);
  if (amplitude == 0.0) {
    store(channel_phase_rad, pixel, nan());
    store(channel_distance_m, pixel, nan());
    return;
  }
  Real turns = multiply(sum.reference_m, real(constants.turns_per_m.x, constants.turns_per_m.y));
  turns = add(turns, negate(round_to_whole(turns)));
  turns = add(turns, real(angle_turns(z)));
  turns = add(turns, real(high(turns) < 0.0 ? 1.0 : 0.0));
  turns = add(turns, real(high(turns) >= 1.0 ? -1.0 : 0.0));
  Real two_pi = real(6.2831855, -1.7484555e-7);
  // Rounding to float must not reach the end of the half-open interval.
  store(channel_phase_rad, pixel, clamp(high(multiply(turns, two_pi)), 0.0, constants.limits.x));
  Real distance = multiply(turns, real(constants.ambiguity_m.x, constants.ambiguity_m.y));
  store(channel_distance_m, pixel, clamp(high(distance), 0.0, constants.limits.y));
}

void store_ground_truth(uint pixel, PixelSum sum) {
  Real hits = real(float(sum.hits));
  store(channel_range_m, pixel, sum.hits > 0u ? high(divide(sum.range, hits)) : nan());
  store(channel_z_m, pixel, sum.hits > 0u ? high(divide(sum.depth, hits)) : nan());
  store(channel_coverage, pixel, float(sum.hits) / float(constants.samples * constants.samples));
}

// Of the sample nearest the pixel's centre; ties go up and left.
void store_ids(uint pixel) {
  uint middle = (constants.samples - 1u) / 2u;
  uvec2 at = uvec2(pixel % constants.columns, pixel / constants.columns) * constants.samples + middle;
  uvec2 tag = Tags(constants.tags).at[at.y * constants.columns * constants.samples + at.x];
  bool hit = tag.x != 0u;
  store(channel_triangle_id, pixel, hit ? tag.y : no_triangle);
  store(channel_object_id, pixel, hit ? Planes(constants.planes).at[tag.y].object : no_triangle);
}

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  if (pixel >= constants.pixels)
    return;
  PixelSum sum = sum_samples(pixel);
  store_return(pixel, sum);
  store_ground_truth(pixel, sum);
  store_ids(pixel);
}
