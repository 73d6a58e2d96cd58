#version 460
// As id_raster.frag, where samples are an even grid: leaves the depth beside the IDs at which the sample's own exact ray meets
// the triangle's plane.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/chip.glsl"
#include "shaders/view/meet.glsl"
#include "shaders/sampling/pixel_id.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/surface_appearance.glsl"
#include "shaders/view/sight.glsl"

layout(push_constant, std430) uniform Constants { IdRasterConstants constants; };
layout(constant_id = constant_general_chip) const uint general_chip = 0;
layout(constant_id = constant_cutouts) const uint cutouts = 0;
layout(location = 0) flat in uint visible_triangle;
layout(location = 0) out uvec4 record;

void main() {
  vec2 fragment = floor(gl_FragCoord.xy);
  Real3 ray = grid_ray(grid_slope, constants.chip, grid_first + 2.0 * fragment, general_chip != 0);
  if (cutouts != 0) {
    // Without the triangle's limits, as id_raster.frag: all ways must see the same holes.
    Real unlimited = divide(real(plane_hi.w, plane_lo.w), dot3(real3(plane_hi.xyz, plane_lo.xyz), ray));
    if (!look_of(constants.shapes, constants.surfaces, visible_triangle, point_at_depth(ray, unlimited)).is_there)
      discard;
  }
  Real depth = depth_on_plane(ray, TrianglePlane(plane_hi, plane_lo, 0.0, 0u, along_m.x, along_m.y));
  record = uvec4(pixel_id(fragment, strip_place.xy, strip_place.z, strip_place.w), visible_triangle, words_of(depth));
}
