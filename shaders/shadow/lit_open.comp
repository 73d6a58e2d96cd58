#version 460
// Which parts of tiles anything may shade: their light from the window's diodes passes an occluder, or a diode stands behind
// their surface. For all others nothing has to be done.
// It has no Real.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shadow/lit_gather.glsl"

void append_open(uint part) {
  Work work = Work(constants.work);
  uint entry = atomicAdd(work.at.list[list_open].count, 1u);
  work.list[list_open * constants.part_count + entry] = part;
  atomicMax(work.at.list[list_open].x, entry / workgroup_size + 1u);
}

bool is_blocked_perhaps(TilePart part, DiodeBox box) {
  LitScene scene = LitScenes(constants.scene).at;
  Shaft shaft = shaft_of(part, box);
  uint node = 0u, steps = 0u;
  bool perhaps = false;
  while (!perhaps && node < scene.nodes && steps < steps_per_walk) {
    uint index = next_occluder(scene.tree, shaft, scene.nodes, node, steps);
    if (index != no_occluder) {
      vec4 plane = Occluders(scene.occluders).at[index].plane_hi;
      perhaps = is_between(plane, Occluders(scene.occluders).at[index].body,
                           heights(plane, part.low.xyz, part.high.xyz), part, box);
    }
  }
  return perhaps || node < scene.nodes; // or the walk was too long
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.part_count)
    return;
  TilePart part = Parts(constants.parts).at[i];
  if (part.own == 0u)
    return;
  DiodeBox box = DiodeBoxes(constants.boxes).at[0];
  if (is_blocked_perhaps(part, box) || lowest_diode(part, box) <= 0.0)
    append_open(i);
}
