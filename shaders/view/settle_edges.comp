#version 460
// Gives samples near edges the triangles that the host found their exact rays to meet, whatever the raster left.
#extension GL_GOOGLE_include_directive : require
#include "shaders/sampling/grid.glsl"
#include "shaders/shared/constants.h"
#include "shaders/view/meet.glsl"

layout(buffer_reference, std430, buffer_reference_align = 4) readonly buffer EdgeSamples { EdgeSample at[]; };

layout(local_size_x = workgroup_size) in;
layout(push_constant, std430) uniform Constants { SettleEdgesConstants constants; };
layout(constant_id = constant_tiled) const uint tiled = 0;
layout(constant_id = constant_depth_records) const uint depth_records = 0;
layout(constant_id = constant_general_chip) const uint general_chip = 0;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.count)
    return;
  EdgeSample edge = EdgeSamples(constants.samples).at[i];
  uvec2 at = uvec2(edge.column, edge.row), pixel = at / constants.side, extent = uvec2(constants.columns, constants.rows);
  uvec2 first = uvec2(constants.column, constants.row), in_strip = pixel - first;
  if (in_strip.x >= extent.x || in_strip.y >= extent.y)
    return;
  bool hit = edge.triangle != no_triangle;
  uvec2 ids = hit ? uvec2(pixel.y * constants.resolution_x + pixel.x + 1u, edge.triangle) : uvec2(0u);
  uint index = id_index(in_strip, at - pixel * constants.side, extent, constants.side, tiled != 0);
  if (depth_records == 0) {
    store_words(constants.ids, index, ids);
    return;
  }
  Real3 ray = ray_of(at - first * constants.side, constants.grid, constants.chip, general_chip != 0);
  Real depth = depth_on_plane(ray, load_plane(constants.planes, hit ? edge.triangle : 0u));
  store_words(constants.ids, 2 * index, ids);
  store_words(constants.ids, 2 * index + 1, words_of(hit ? depth : real(0.0)));
}
