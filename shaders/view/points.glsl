// A sample's point, surface and backscatter: both points passes store them, and the uniform-pixel pass and the demodulation of
// depth records use them at once.
#ifndef PMDSIM_POINTS_GLSL
#define PMDSIM_POINTS_GLSL

#include "shaders/shared/buffers.glsl"
#include "shaders/view/meet.glsl"
#include "shaders/view/surface_appearance.glsl"
#include "shaders/shared/real.glsl"
#include "shaders/shared/constants.h"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_surface_vectors) const uint surface_vectors = 1;
layout(constant_id = constant_vignetting) const uint vignetting = 0;
layout(constant_id = constant_painted) const uint painted = 0;

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

// The buffers that samples are stored in, as in PointsConstants.
struct PointBuffers {
  uvec2 position, surface, backscatter;
  uvec2 shapes, surfaces; // in: paint
};

// A sample that sees nothing: no backscatter, the point in the lens itself.
void store_miss(PointBuffers to, uint i) {
  store_position(to.position, i, Real3(real(0.0), real(0.0), real(0.0)));
  Floats(to.backscatter).at[i] = 0.0;
}

// cos^4 of the angle to the optical axis, for vignetting.
float cos4(vec3 ray) {
  float cosine = max(0.0, ray.z);
  float cos2 = cosine * cosine / dot(ray, ray);
  return cos2 * cos2;
}

// B of the shape `id` at a point that the ray, of any length, leads to, over the cosine, with the lens's vignetting.
float backscatter_of(uvec2 shapes, uvec2 surfaces_at, vec3 ray, Real3 point, uint id, TrianglePlane plane) {
  float backscatter = plane.backscatter;
  if (painted != 0)
    backscatter = look_of(shapes, surfaces_at, id, point).backscatter;
  return vignetting != 0 ? backscatter * cos4(ray) : backscatter;
}

// A sample whose ray, of any length, meets the shape `id` at `point` of its plane.
void store_point(PointBuffers to, uint i, vec3 ray, Real3 point, uint id, TrianglePlane plane) {
  store_position(to.position, i, point);
  Floats(to.backscatter).at[i] = backscatter_of(to.shapes, to.surfaces, ray, point, id, plane);
  if (surface_vectors > 0)
    store_vec4(to.surface, surface_vectors * i, vec4(plane.plane_hi.xyz, -plane.plane_hi.w));
  if (surface_vectors > 1)
    store_vec4(to.surface, surface_vectors * i + 1, vec4(plane.plane_lo.xyz, -plane.plane_lo.w));
}

#endif
