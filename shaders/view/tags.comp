#version 460
// From the keys that fragments left to their tags, in place; where samples are an even grid, records with the depths at which
// their rays meet their triangles' planes, from keys or from tags.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "shaders/sampling/grid.glsl"
#include "shaders/view/meet.glsl"
#include "shaders/sampling/pixel_id.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { TagsConstants constants; };
layout(constant_id = constant_tags_records) const uint leaves_records = 0;
layout(constant_id = constant_tags_chip) const uint general_chip = 0;
layout(constant_id = constant_tags_keys) const uint from_keys = 1;

uvec2 tag_of_key(uvec2 key, uvec2 fragment) {
  uvec2 in_tile = fragment % uvec2(constants.tile_columns, constants.tile_rows);
  uint pixel = pixel_id(vec2(in_tile), uvec2(constants.column, constants.row), constants.resolution_x,
                        constants.fragments_per_pixel_side);
  return key == uvec2(0u) ? uvec2(0u) : uvec2(pixel, ~key.x);
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.fragments)
    return;
  uint at = leaves_records != 0 ? 2 * i : i;
  uvec2 tag = load_tag(constants.tags, at);
  uvec2 fragment = row_by_row(i, constants.grid.columns, constants.grid.inverse_columns);
  if (from_keys != 0) {
    tag = tag_of_key(tag, fragment);
    store_tag(constants.tags, at, tag);
  }
  if (leaves_records != 0) {
    bool hit = tag.x != 0u;
    Real3 ray = ray_of(fragment, constants.grid, constants.chip, general_chip != 0);
    Real depth = depth_on_plane(ray, load_plane(constants.planes, hit ? tag.y : 0u));
    store_tag(constants.tags, at + 1, words_of(hit ? depth : real(0.0)));
  }
}
