#version 460
// A triangle's corner, already projected onto the raster and snapped to its 1/256 fragment by the host, so that
// every step from here to the rasteriser is exact and a strip's place in the frame cannot change what is covered.
// RECORD_DEPTH: with what its fragments need for their depths.
#extension GL_GOOGLE_include_directive : require
#ifdef RECORD_DEPTH
#define VERTEX_STAGE
#include "shaders/shared/buffers.glsl"
#include "shaders/view/sight.glsl"
#endif
#include "shaders/shared/constants.h"
#include "shaders/shared/interface.h"

layout(push_constant, std430) uniform Constants { IdRasterConstants constants; };
layout(location = 0) in vec3 corner; // x_fragments, y_fragments, inverse_depth
layout(location = 1) in uint triangle;
layout(location = 0) flat out uint visible_triangle;

layout(constant_id = constant_half_viewport) const float half_viewport = 8192.0; // a power of two

void main() {
  // The block's fragments fill the middle half of the viewport.
  gl_Position = vec4((corner.xy - constants.shift - 0.5 * half_viewport) / half_viewport, corner.z, 1.0);
  visible_triangle = triangle;
#ifdef RECORD_DEPTH
  TrianglePlane plane = load_plane(constants.planes, triangle);
  plane_hi = plane.plane_hi;
  plane_lo = plane.plane_lo;
  along_m = vec2(plane.along_min, plane.along_max);
  grid_slope = constants.slope;
  grid_first = constants.first;
  strip_place = uvec4(constants.column, constants.row, constants.resolution_x, constants.fragments_per_pixel_side);
#endif
}
