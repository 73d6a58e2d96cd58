// Buffers by their device address.
#ifndef PMDSIM_BUFFERS_GLSL
#define PMDSIM_BUFFERS_GLSL

#include "shaders/shared/interface.h"
#include "shaders/shared/real.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vec4s { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer WordPairs { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Planes { TrianglePlane at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Chips { ChipPlace at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Lenses {
  LensModel at;
  float guess[]; // lens_guesses
};
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BlockPlanes { BlockPlane at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Views { RasterView at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Diodes { GroupSource at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Tones { Tone at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer LightRuns { LightRun at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer PointPolynomialsOf { PointPolynomials at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Frequencies { Frequency at[]; };

// Where the IDs of a pixel's sample are, in a strip of `extent` pixels (interface.h).
uint id_index(uvec2 pixel, uvec2 subsample, uvec2 extent, uint samples, bool tiled) {
  uvec2 at = tiled ? subsample * extent + pixel : pixel * samples + subsample;
  return at.y * extent.x * samples + at.x;
}

// Likewise of the record of sample i, counted sub-sample by sub-sample, where records lie row by row; for an invocation that
// only pads, the last place that has memory.
uint record_index(uint i, uint padded_pixels, uint columns, uint samples) {
  uint pixel = i % padded_pixels, subsample = i / padded_pixels;
  uint at = id_index(uvec2(pixel % columns, pixel / columns), uvec2(subsample % samples, subsample / samples), uvec2(columns, 0),
                     samples, false);
  return min(at, padded_pixels * samples * samples - 1);
}

// Lavapipe fetches and stores lane by lane, a double as fast as a float: two floats at a time.
#ifdef REAL_DOUBLE_FLOAT
vec4 load_vec4(uvec2 address, uint i) { return Vec4s(address).at[i]; }
void store_vec4(uvec2 address, uint i, vec4 value) { Vec4s(address).at[i] = value; }
uvec2 load_words(uvec2 address, uint i) { return WordPairs(address).at[i]; }
void store_words(uvec2 address, uint i, uvec2 words) { WordPairs(address).at[i] = words; }
#else
layout(buffer_reference, std430, buffer_reference_align = 8) buffer DoubleWords { double at[]; };
vec2 two_floats(double pair) { return uintBitsToFloat(unpackDouble2x32(pair)); }
vec4 load_vec4(uvec2 address, uint i) {
  DoubleWords from = DoubleWords(address);
  return vec4(two_floats(from.at[2 * i]), two_floats(from.at[2 * i + 1]));
}
void store_vec4(uvec2 address, uint i, vec4 value) {
  DoubleWords to = DoubleWords(address);
  to.at[2 * i] = packDouble2x32(floatBitsToUint(value.xy));
  to.at[2 * i + 1] = packDouble2x32(floatBitsToUint(value.zw));
}
uvec2 load_words(uvec2 address, uint i) { return unpackDouble2x32(DoubleWords(address).at[i]); }
void store_words(uvec2 address, uint i, uvec2 words) { DoubleWords(address).at[i] = packDouble2x32(words); }
#endif
// A sample's record (interface.h).
uvec2 load_record_ids(uvec2 address, uint i) { return load_words(address, 2 * i); }
// The IDs of samples that have a record or, where `records` is 0, IDs alone.
uvec2 load_ids(uvec2 address, uint i, uint records) { return load_words(address, records != 0 ? 2 * i : i); }
Real load_record_depth(uvec2 address, uint i) { return real_of(load_words(address, 2 * i + 1)); }

TrianglePlane load_plane(uvec2 address, uint i) {
  vec4 rest = load_vec4(address, 3 * i + 2);
  return TrianglePlane(load_vec4(address, 3 * i), load_vec4(address, 3 * i + 1), rest.x, floatBitsToUint(rest.y), rest.z, rest.w);
}

// The points of samples, camera frame, m: Real[3] each.
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Reals { Real at[]; };

Real3 load_position(uvec2 address, uint i) {
  Reals from = Reals(address);
  return Real3(from.at[3 * i], from.at[3 * i + 1], from.at[3 * i + 2]);
}
void store_position(uvec2 address, uint i, Real3 value) {
  Reals to = Reals(address);
  to.at[3 * i] = value.x;
  to.at[3 * i + 1] = value.y;
  to.at[3 * i + 2] = value.z;
}

#endif
