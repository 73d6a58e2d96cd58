#version 460
// From the keys that fragments left to their tags, in place.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "buffers.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { TagsConstants constants; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.fragments)
    return;
  uvec2 key = load_tag(constants.tags, i);
  uint side = constants.fragments_per_pixel_side;
  uvec2 fragment = uvec2(i % constants.tag_columns, i / constants.tag_columns);
  uvec2 in_tile = fragment % uvec2(constants.tile_columns, constants.tile_rows);
  uvec2 pixel = uvec2(constants.column, constants.row) + in_tile / max(side, 1u);
  uvec2 tag = uvec2(side == 0u ? 1u : pixel.y * constants.resolution_x + pixel.x + 1u, ~key.x);
  store_tag(constants.tags, i, key == uvec2(0u) ? uvec2(0u) : tag);
}
