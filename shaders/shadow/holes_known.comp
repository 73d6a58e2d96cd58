#version 460
// Marks the tiles that are known as shaded before shapes with holes are looked at.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/holes.glsl"

layout(local_size_x = workgroup_size) in;

void main() {
  ShadedTiles shaded = ShadedTiles(constants.shaded);
  if (gl_GlobalInvocationID.x < shaded.at.count)
    HoleLists(constants.work).list[known_at(shaded.list[gl_GlobalInvocationID.x])] = 1u;
}
