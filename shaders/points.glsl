// What both points passes leave of a sample.
#ifndef PMDSIM_POINTS_GLSL
#define PMDSIM_POINTS_GLSL

#include "buffers.glsl"
#include "real.glsl"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_surfaces) const uint surfaces = 1;
layout(constant_id = constant_vignetting) const uint vignetting = 0;

// Which sample an invocation is.
struct Sample {
  uint pixel; // of the strip's; beyond them where the invocation only pads
  uvec2 in_strip;
  uvec2 in_frame;
  uvec2 subsample;
};

Sample sample_of(uint i, Strip strip) {
  uint subsample = i / strip.padded_pixels;
  uint pixel = i - subsample * strip.padded_pixels;
  uvec2 in_strip = uvec2(pixel % strip.columns, pixel / strip.columns);
  return Sample(pixel, in_strip, uvec2(strip.column, strip.row) + in_strip,
                uvec2(subsample % strip.samples, subsample / strip.samples));
}

// A sample that sees nothing: no backscatter, the point in the lens itself.
void store_miss(uvec2 position_hi, uvec2 backscatter, uint i) {
  store_vec3(position_hi, i, vec3(0.0));
  Floats(backscatter).at[i] = 0.0;
}

// cos^4 of the angle to the optical axis, for vignetting.
float cos4(vec3 ray) {
  float cosine = max(0.0, ray.z);
  float cos2 = cosine * cosine / dot(ray, ray);
  return cos2 * cos2;
}

#endif
