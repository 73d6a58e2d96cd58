#version 460
// As id_raster.frag, for scenes whose shapes have holes: what is not there where the fragment's ray meets it leaves no tag.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#ifdef TAG_KEYS
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#include "shaders/view/surface_appearance.glsl"
#include "shaders/view/tag.glsl"

layout(push_constant, std430) uniform Constants { VisibilityConstants constants; };
layout(location = 0) flat in uint visible_triangle;

Real3 term(float factor, vec4 hi, vec4 lo) { return scale3(real3(hi.xyz, lo.xyz), real(factor)); }

// Of the sample that the fragment stands for, of any length.
Real3 fragment_ray() {
  BlockPlane block = BlockPlanes(constants.block).at;
  vec2 place = gl_FragCoord.xy - vec2(constants.tile_x, constants.tile_y) +
               vec2(constants.block_x, constants.block_y) + constants.sample_shift;
  Real3 ray = add3(term(place.x, block.x_hi, block.x_lo), term(place.y, block.y_hi, block.y_lo));
  return add3(ray, real3(block.corner_hi.xyz, block.corner_lo.xyz));
}

void main() {
  TrianglePlane plane = Planes(constants.planes).at[visible_triangle];
  Real3 ray = fragment_ray();
  Real3 normal = real3(plane.plane_hi.xyz, plane.plane_lo.xyz);
  Real3 point = scale3(ray, divide(real(plane.plane_hi.w, plane.plane_lo.w), dot3(normal, ray)));
  if (!look_of(constants.shapes, constants.surfaces, visible_triangle, point).is_there)
    discard;
  leave_tag(constants, uvec2(gl_FragCoord.xy), visible_triangle);
}
