// The tag that a fragment leaves (interface.h).
#ifndef PMDSIM_TAG_GLSL
#define PMDSIM_TAG_GLSL

#include "interface.h"

// Where keys are left: in place of a colour and a depth the nearest fragment's key stays, by an atomic operation.
#ifdef TAG_KEYS
layout(buffer_reference, std430, buffer_reference_align = 8) buffer Keys { uint64_t at[]; };

void leave_tag(VisibilityConstants constants, uvec2 fragment, uint triangle) {
  uint64_t key = packUint2x32(uvec2(~triangle, floatBitsToUint(gl_FragCoord.z)));
  atomicMax(Keys(constants.tags).at[fragment.y * constants.tag_columns + fragment.x], key);
}
#else
layout(location = 0) out uvec2 tag;

void leave_tag(VisibilityConstants constants, uvec2 fragment, uint triangle) {
  uint side = constants.fragments_per_pixel_side;
  uvec2 in_tile = fragment - uvec2(constants.tile_x, constants.tile_y);
  uvec2 pixel = uvec2(constants.column, constants.row) + in_tile / max(side, 1u);
  tag = uvec2(side == 0u ? 1u : pixel.y * constants.resolution_x + pixel.x + 1u, triangle);
}
#endif

#endif
