#version 460
// The point of the scene that each sample sees, recomputed from its triangle's plane and the sample's own exact ray:
// the raster's depth is off by up to 20 micrometres on grazing facets.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "buffers.glsl"
#include "real.glsl"

layout(local_size_x = workgroup_size) in;
layout(constant_id = constant_surfaces) const uint surfaces = 1;
layout(push_constant, std430) uniform Constants { PointsConstants constants; };

// What a sample that sees nothing leaves: no backscatter, depth 0.
void store_miss(uint i) {
  store_vec3(constants.position_hi, i, vec3(0.0));
  Floats(constants.backscatter).at[i] = 0.0;
}

// The ray (x, y, 1) of a sample, from the lens; `position` counts samples over the whole frame, from its top left.
Real3 sample_ray(uvec2 position) {
  Strip strip = constants.strip;
  ivec2 extent = ivec2(strip.resolution_x, strip.resolution_y) * int(strip.samples);
  ivec2 from_axis = 2 * ivec2(position) + 1 - extent; // in half samples, exact in float
  Real x = multiply(real(float(from_axis.x)), real(constants.slope.x, constants.slope.y));
  Real y = multiply(real(float(from_axis.y)), real(constants.slope.z, constants.slope.w));
  return Real3(x, y, real(1.0));
}

void store_hit(uint i, Real3 ray, TrianglePlane plane) {
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  Real offset = real(plane.plane_hi.w, plane.plane_lo.w);
  // A sample that an edge-on triangle covers only by the raster's snapping must not leave that triangle's depths.
  Real depth = real_clamp(divide(offset, dot3(normal, ray)), plane.depth_min_m, plane.depth_max_m);
  Real3 point = Real3(multiply(ray.x, depth), multiply(ray.y, depth), depth);
  store_vec3(constants.position_hi, i, high3(point));
  store_vec3(constants.position_lo, i, rest3(point));
  Floats(constants.backscatter).at[i] = plane.backscatter;
  if (surfaces != 0)
    Vec4s(constants.surface).at[i] = vec4(plane.plane_hi.xyz, -plane.plane_hi.w);
}

void main() {
  Strip strip = constants.strip;
  uint i = gl_GlobalInvocationID.x;
  uint subsample = i / strip.padded_pixels;
  uint pixel = i - subsample * strip.padded_pixels;
  if (pixel >= strip.columns * strip.rows) {
    store_miss(i);
    return;
  }
  uvec2 corner = uvec2(pixel % strip.columns, pixel / strip.columns) * strip.samples;
  uvec2 in_strip = corner + uvec2(subsample % strip.samples, subsample / strip.samples);
  uvec2 tag = Tags(constants.tags).at[in_strip.y * strip.columns * strip.samples + in_strip.x];
  if (tag.x == 0u) {
    store_miss(i);
    return;
  }
  uvec2 in_frame = uvec2(strip.column, strip.row) * strip.samples + in_strip;
  store_hit(i, sample_ray(in_frame), Planes(constants.planes).at[tag.y]);
}
