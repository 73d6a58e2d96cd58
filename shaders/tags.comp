#version 460
// From the keys that fragments left to their tags or, where samples are an even grid, their records, in place.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#include "grid.glsl"
#include "meet.glsl"
#include "pixel_id.glsl"

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { TagsConstants constants; };
layout(constant_id = constant_tags_records) const uint leaves_records = 0;
layout(constant_id = constant_tags_chip) const uint general_chip = 0;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.fragments)
    return;
  uint at = leaves_records != 0 ? 2 * i : i;
  uvec2 key = load_tag(constants.tags, at);
  bool hit = key != uvec2(0u);
  uint triangle = hit ? ~key.x : 0u;
  uvec2 fragment = row_by_row(i, constants.grid.columns, constants.grid.inverse_columns);
  uvec2 in_tile = fragment % uvec2(constants.tile_columns, constants.tile_rows);
  uint pixel = pixel_id(vec2(in_tile), uvec2(constants.column, constants.row), constants.resolution_x,
                        constants.fragments_per_pixel_side);
  store_tag(constants.tags, at, hit ? uvec2(pixel, triangle) : uvec2(0u));
  if (leaves_records != 0) {
    Real3 ray = ray_of(fragment, constants.grid, constants.chip, general_chip != 0);
    Real depth = depth_on_plane(ray, load_plane(constants.planes, triangle));
    store_tag(constants.tags, at + 1, words_of(hit ? depth : real(0.0)));
  }
}
