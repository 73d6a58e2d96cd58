#version 460
// The point of the scene that each sample sees, recomputed from its triangle's plane and the sample's own exact ray:
// the raster's depth is off by up to 20 micrometres on grazing facets.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "buffers.glsl"
#include "chip.glsl"
#include "points.glsl"
#include "real.glsl"

layout(push_constant, std430) uniform Constants { PointsConstants constants; };
layout(constant_id = constant_chip) const uint general_chip = 0;
layout(constant_id = constant_tiled) const uint tiled = 0;

// The ray (x, y, 1) of a sample, from the lens.
Real3 sample_ray(Sample at) {
  Strip strip = constants.strip;
  if (general_chip != 0) {
    Real3 place = place_on_chip(Chips(constants.chip).at, strip, at.in_frame, at.subsample);
    return Real3(divide(place.x, place.z), divide(place.y, place.z), real(1.0));
  }
  ivec2 extent = ivec2(strip.resolution_x, strip.resolution_y) * int(strip.samples);
  uvec2 position = at.in_frame * strip.samples + at.subsample;
  ivec2 from_axis = 2 * ivec2(position) + 1 - extent; // in half samples, exact in float
  Real x = multiply(real(float(from_axis.x)), real(constants.slope.x, constants.slope.y));
  Real y = multiply(real(float(from_axis.y)), real(constants.slope.z, constants.slope.w));
  return Real3(x, y, real(1.0));
}

void store_hit(PointBuffers to, uint i, Real3 ray, uint id, TrianglePlane plane) {
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  Real offset = real(plane.plane_hi.w, plane.plane_lo.w);
  // A sample that an edge-on triangle covers only by the raster's snapping must not leave that triangle's depths.
  Real depth = real_clamp(divide(offset, dot3(normal, ray)), plane.along_min, plane.along_max);
  store_point(to, i, high3(ray), Real3(multiply(ray.x, depth), multiply(ray.y, depth), depth), id, plane);
}

void main() {
  Strip strip = constants.strip;
  uint i = gl_GlobalInvocationID.x;
  PointBuffers to = PointBuffers(constants.position_hi, constants.position_lo, constants.surface, constants.backscatter,
                                 constants.shapes, constants.surfaces);
  Sample at = sample_of(i, strip);
  Real3 ray = sample_ray(at); // before anything branches, so that lavapipe reads the chip once for all lanes
  if (at.pixel >= strip.columns * strip.rows) {
    store_miss(to, i);
    return;
  }
  uint tag_at = tag_index(at.in_strip, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, tiled != 0);
  uvec2 tag = Tags(constants.tags).at[tag_at];
  if (tag.x == 0u) {
    store_miss(to, i);
    return;
  }
  store_hit(to, i, ray, tag.y, Planes(constants.planes).at[tag.y]);
}
