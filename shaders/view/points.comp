#version 460
// The point of the scene that each sample sees, recomputed from its triangle's plane and the sample's own exact ray:
// the raster's depth is off by up to 20 micrometres on grazing facets.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/buffers.glsl"
#include "shaders/sampling/chip.glsl"
#include "shaders/sampling/pixel_list.glsl"
#include "shaders/view/points.glsl"
#include "shaders/shared/real.glsl"

layout(push_constant, std430) uniform Constants { PointsConstants constants; };
layout(constant_id = constant_general_chip) const uint general_chip = 0;
layout(constant_id = constant_tiled) const uint tiled = 0;
layout(constant_id = constant_listed) const uint listed = 0;
layout(constant_id = constant_depth_records) const uint depth_records = 0;

Real3 sample_ray(Sample at) {
  Strip strip = constants.strip;
  vec2 from_centre = from_centre_of(at.subsample, strip);
  return general_chip != 0 ? chip_ray(Chips(constants.chip).at, strip, at.in_frame, from_centre)
                           : nominal_ray(constants.slope, strip, at.in_frame, from_centre);
}

void main() {
  Strip strip = constants.strip;
  uint i = gl_GlobalInvocationID.x;
  if (listed != 0)
    i = listed_sample(PixelLists(constants.list), i, strip.padded_pixels);
  PointBuffers to = PointBuffers(constants.position, constants.surface, constants.backscatter,
                                 constants.shapes, constants.surfaces);
  Sample at = sample_of(i, strip);
  Real3 ray = sample_ray(at); // before anything branches, so that lavapipe reads the chip once for all lanes
  if (at.pixel >= strip.columns * strip.rows) {
    store_miss(to, i);
    return;
  }
  uint id_at = id_index(at.in_strip, at.subsample, uvec2(strip.columns, strip.rows), strip.samples, tiled != 0);
  uvec2 ids = load_ids(constants.ids, id_at, depth_records);
  if (ids.x == 0u) {
    store_miss(to, i);
    return;
  }
  TrianglePlane plane = load_plane(constants.planes, ids.y);
  store_point(to, i, high3(ray), point_on_plane(ray, plane), ids.y, plane);
}
