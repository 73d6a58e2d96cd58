#version 460
// Which parts of tiles anything may shade: their light from the window's diodes passes an occluder, or a diode stands behind
// their surface. For all others nothing has to be done.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "lit_gather.glsl"

void append_open(uint part) {
  Work work = Work(constants.work);
  uint entry = atomicAdd(work.at.open.count, 1u);
  work.list[entry] = part;
  atomicMax(work.at.open.x, entry / workgroup_size + 1u);
}

bool is_blocked_perhaps(TilePart part, DiodeBox box) {
  LitScene scene = LitScenes(constants.scene).at;
  Shaft shaft = shaft_between(part.low.xyz, part.high.xyz, box.low.xyz, box.high.xyz);
  uint node = 0u, steps = 0u;
  while (node < scene.nodes && steps < steps_per_walk) {
    Leaf leaf = next_leaf(scene.tree, shaft, scene.nodes, node, steps);
    for (uint k = 0; k < leaf.count; ++k, steps += 1u + part.own) {
      Occluder occluder = Occluders(scene.occluders).at[leaf.first + k];
      if (may_block(occluder, part, box, shaft) && (part.own > own_shapes || rises_over_own(part, occluder)))
        return true;
    }
  }
  return node < scene.nodes; // the walk was too long
}

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= constants.part_count)
    return;
  TilePart part = Parts(constants.parts).at[i];
  if (part.low.x > part.high.x)
    return;
  DiodeBox box = DiodeBoxes(constants.boxes).at[0];
  if (is_blocked_perhaps(part, box) || !all_face(part, box))
    append_open(i);
}
