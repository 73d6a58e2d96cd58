// The tag that a fragment leaves (interface.h).
#ifndef PMDSIM_TAG_GLSL
#define PMDSIM_TAG_GLSL

#include "shaders/shared/interface.h"
#include "shaders/sampling/pixel_id.glsl"

// Where keys are left: in place of a colour and a depth the nearest fragment's key stays, by an atomic operation.
#ifdef TAG_KEYS
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Keys { uint64_t at[]; };

void leave_tag(VisibilityConstants constants, uvec2 fragment, uint triangle) {
  uint64_t key = packUint2x32(uvec2(~triangle, floatBitsToUint(gl_FragCoord.z)));
  atomicMax(Keys(constants.tags).at[constants.tag_stride * (fragment.y * constants.tag_columns + fragment.x)], key);
}
#else
layout(location = 0) out uvec2 tag;

void leave_tag(VisibilityConstants constants, uvec2 fragment, uint triangle) {
  vec2 in_tile = vec2(fragment - uvec2(constants.tile_x, constants.tile_y));
  uvec2 first_pixel = uvec2(constants.column, constants.row);
  tag = uvec2(pixel_id(in_tile, first_pixel, constants.resolution_x, constants.fragments_per_pixel_side), triangle);
}
#endif

#endif
