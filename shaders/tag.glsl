// The tag that a fragment leaves (interface.h).
#ifndef PMDSIM_TAG_GLSL
#define PMDSIM_TAG_GLSL

#include "interface.h"

uvec2 tag_of_fragment(VisibilityConstants constants, uvec2 fragment, uint triangle) {
  uint side = constants.fragments_per_pixel_side;
  uvec2 in_tile = fragment - uvec2(constants.tile_x, constants.tile_y);
  uvec2 pixel = uvec2(constants.column, constants.row) + in_tile / max(side, 1u);
  return uvec2(side == 0u ? 1u : pixel.y * constants.resolution_x + pixel.x + 1u, triangle);
}

#endif
