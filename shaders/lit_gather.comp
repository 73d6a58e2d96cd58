#version 460
// For each open part of a tile and each bundle of diodes: the occluders that may stand between them. Where there are few, they
// will be tried one by one; where there are many, or such as have holes, rays will be traced.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require
#include "lit_gather.glsl"

const uint too_many = largest_candidates + 1;

// Stores the candidates of a slot and returns how many they are, or too_many.
uint gather(uint slot, TilePart part, DiodeBox box) {
  LitScene scene = LitScenes(constants.scene).at;
  Shaft shaft = shaft_between(part.low.xyz, part.high.xyz, box.low.xyz, box.high.xyz);
  Words candidates = Words(constants.candidates);
  uint node = 0u, steps = 0u, count = 0u;
  while (node < scene.nodes && steps < steps_per_walk && count < too_many) {
    Leaf leaf = next_leaf(scene.tree, shaft, scene.nodes, node, steps);
    for (uint k = 0; k < leaf.count; ++k, ++steps) {
      Occluder occluder = Occluders(scene.occluders).at[leaf.first + k];
      if (count < too_many && may_block(occluder, part, box, shaft)) {
        count = occluder.may_be_absent != 0u ? too_many : count + 1u;
        if (count < too_many)
          candidates.at[slot * slot_words + count] = leaf.first + k;
      }
    }
  }
  return node < scene.nodes ? too_many : count;
}

uint keep_what_rises(uint slot, TilePart part, uint count) {
  Words candidates = Words(constants.candidates);
  uint kept = 0u;
  for (uint k = 1u; k <= count; ++k) {
    uint index = candidates.at[slot * slot_words + k];
    if (rises_over_own(part, Occluders(LitScenes(constants.scene).at.occluders).at[index]))
      candidates.at[slot * slot_words + ++kept] = index;
  }
  return kept;
}

void main() {
  uint entry = gl_GlobalInvocationID.x, bundle = gl_WorkGroupID.y;
  Work work = Work(constants.work);
  if (entry >= work.at.open.count)
    return;
  TilePart part = Parts(constants.parts).at[work.list[entry]];
  DiodeBox box = DiodeBoxes(constants.boxes).at[1u + bundle];
  uint slot = candidate_slot(entry, constants.bundles, bundle);
  uint count = slot < constants.slots ? gather(slot, part, box) : too_many;
  if (count < too_many && part.own <= own_shapes)
    count = keep_what_rises(slot, part, count);
  if (count == too_many) {
    work.list[traced_list(constants.part_count, bundle) + atomicAdd(work.at.traced[bundle].x, 1u)] = entry;
  } else if (count > 0u || !all_face(part, box)) {
    Words(constants.candidates).at[slot * slot_words] = count;
    work.list[tried_list(constants.part_count, bundle) + atomicAdd(work.at.tried[bundle].x, 1u)] = entry;
  }
}
