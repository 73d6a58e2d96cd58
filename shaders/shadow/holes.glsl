// Parts that the shaders of the pass over shapes with holes share: samples in tiles, and lists of tiles.
#ifndef PMDSIM_HOLES_GLSL
#define PMDSIM_HOLES_GLSL

#include "shaders/shadow/holes_interface.h"
#include "shaders/shadow/shaft.glsl"
#include "shaders/shadow/tiles.glsl"

layout(push_constant, std430) uniform Constants { HolesConstants constants; };

layout(set = 0, binding = 0) uniform usamplerBuffer shape_texels; // hole_texels of each shape: Occluder
layout(set = 0, binding = 1) uniform samplerBuffer box_texels;    // low and high of each box
layout(set = 0, binding = 2) uniform samplerBuffer place_texels;  // of each diode, as in BundleDiodes

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Windows { HolesWindow at; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer Boxes { TileBox at[]; };
layout(buffer_reference, std430, buffer_reference_align = 16) buffer HoleLists {
  HolesWork at;
  uint list[];
};

uint tile_at(uint range, uint entry) { return range * constants.tiles + entry; }

Real3 point_of(TileSample at, HolesWindow window) {
  return point_of(at, constants.strip, constants.position, constants.ids, window.slope, window.chip);
}

// All the ways from a box of points to the window's diodes, widened by rounding.
Shaft shaft_to_diodes(vec3 low, vec3 high, HolesWindow window) {
  vec3 size = max(abs(low), abs(high)), diodes = max(abs(window.box.low.xyz), abs(window.box.high.xyz));
  vec3 rounding = vec3(4e-7 * (size.x + size.y + size.z));
  vec3 of_diodes = rounding + 1e-6 * (diodes.x + diodes.y + diodes.z);
  return shaft_between(low - rounding, high + rounding, window.box.low.xyz - of_diodes, window.box.high.xyz + of_diodes);
}

bool meets_box(Shaft shaft, uint box) {
  return may_meet(shaft, texelFetch(box_texels, int(2u * box)).xyz, texelFetch(box_texels, int(2u * box + 1u)).xyz);
}

#endif
