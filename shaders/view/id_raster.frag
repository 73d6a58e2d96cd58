#version 460
// Gives a visible fragment its pixel ID and its triangle ID (interface.h); the depth test keeps the nearest. Where shapes have
// holes, a shape that is not there where the fragment's ray meets it leaves no ids.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/pixel_id.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/surface_appearance.glsl"

layout(push_constant, std430) uniform Constants { IdRasterConstants constants; };
layout(constant_id = constant_cutouts) const uint cutouts = 0;
layout(location = 0) flat in uint visible_triangle;
layout(location = 0) out uvec2 ids;

Real3 term(float factor, vec4 hi, vec4 lo) { return scale3(real3(hi.xyz, lo.xyz), real(factor)); }

// The ray of the sample that the fragment stands for, of any length.
Real3 fragment_ray() {
  BlockPlane block = BlockPlanes(constants.block).at;
  vec2 place = gl_FragCoord.xy - vec2(constants.tile_x, constants.tile_y) +
               vec2(constants.block_x, constants.block_y) + constants.sample_shift;
  Real3 ray = add3(term(place.x, block.x_hi, block.x_lo), term(place.y, block.y_hi, block.y_lo));
  return add3(ray, real3(block.corner_hi.xyz, block.corner_lo.xyz));
}

bool is_there() {
  TrianglePlane plane = Planes(constants.planes).at[visible_triangle];
  Real3 ray = fragment_ray();
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  Real3 point = scale3(ray, divide(real(plane.plane_hi.w, plane.plane_lo.w), dot3(normal, ray)));
  return look_of(constants.shapes, constants.surfaces, visible_triangle, point).is_there;
}

void main() {
  if (cutouts != 0) { // a discard that nobody asks for would end early depth tests
    if (!is_there())
      discard;
  }
  vec2 in_tile = vec2(uvec2(gl_FragCoord.xy) - uvec2(constants.tile_x, constants.tile_y));
  uvec2 first_pixel = uvec2(constants.column, constants.row);
  ids = uvec2(pixel_id(in_tile, first_pixel, constants.resolution_x, constants.fragments_per_pixel_side), visible_triangle);
}
