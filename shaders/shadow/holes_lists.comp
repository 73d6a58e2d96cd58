#version 460
// Lists for each range of shapes the tiles from which light may pass one of them on its way to a diode. An invocation is a tile.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/holes.glsl"

layout(local_size_x = workgroup_size) in;

void list_tile(uint range, uint tile) {
  HoleLists lists = HoleLists(constants.work);
  uint entry = atomicAdd(lists.at.ranges[range].count, 1u);
  lists.list[tile_at(range, entry)] = tile;
  atomicMax(lists.at.ranges[range].groups_y, min(entry + 1u, workgroups_per_row));
  atomicMax(lists.at.ranges[range].groups_z, entry / workgroups_per_row + 1u);
}

void main() {
  uint tile = gl_GlobalInvocationID.x;
  if (tile >= constants.tiles)
    return;
  HolesWindow window = Windows(constants.window).at;
  TileBox box = Boxes(constants.boxes).at[tile];
  if (box.low.x > box.high.x)
    return;
  Shaft shaft = shaft_to_diodes(box.low.xyz, box.high.xyz, window);
  uint ranges = (window.shapes + hole_range - 1u) / hole_range, last = min(ranges, constants.first_range + hole_batch);
  for (uint range = constants.first_range; range < last; ++range)
    if (meets_box(shaft, window.first_range + range))
      list_tile(range - constants.first_range, tile);
}
