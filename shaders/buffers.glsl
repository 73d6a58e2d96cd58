// Buffers by their device address.
#ifndef PMDSIM_BUFFERS_GLSL
#define PMDSIM_BUFFERS_GLSL

#include "interface.h"

layout(buffer_reference, std430, buffer_reference_align = 16) buffer Vec4s { vec4 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Floats { float at[]; };
layout(buffer_reference, std430, buffer_reference_align = 4) buffer Words { uint at[]; };
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Tags { uvec2 at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Planes { TrianglePlane at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Corners { TriangleCorners at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Chips { ChipPlace at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Lenses {
  LensModel at;
  float guess[]; // lens_guesses
};
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer BlockPlanes { BlockPlane at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Views { RasterView at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Diodes { GroupDiode at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Tones { Tone at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer LightRuns { LightRun at; };
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Frequencies { Frequency at[]; };

// Where the tag of a pixel's sample is, in a strip of `extent` pixels (interface.h).
uint tag_index(uvec2 pixel, uvec2 subsample, uvec2 extent, uint samples, bool tiled) {
  uvec2 at = tiled ? subsample * extent + pixel : pixel * samples + subsample;
  return at.y * extent.x * samples + at.x;
}

vec3 load_vec3(uvec2 address, uint i) {
  Floats from = Floats(address);
  return vec3(from.at[3 * i], from.at[3 * i + 1], from.at[3 * i + 2]);
}
void store_vec3(uvec2 address, uint i, vec3 value) {
  Floats to = Floats(address);
  to.at[3 * i] = value.x;
  to.at[3 * i + 1] = value.y;
  to.at[3 * i + 2] = value.z;
}

#endif
