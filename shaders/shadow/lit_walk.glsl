// Walks through the tree over the occluders.
#ifndef PMDSIM_LIT_WALK_GLSL
#define PMDSIM_LIT_WALK_GLSL

#include "shaders/shadow/occlusion.glsl"
#include "shaders/shadow/shaft.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Tree { TreeNode at[]; };

bool may_meet(Shaft shaft, TreeNode box) {
  return may_meet(shaft, vec3(box.low_x, box.low_y, box.low_z), vec3(box.high_x, box.high_y, box.high_z));
}

// Goes on from `node` to the next occluder whose box is in the shaft, and past it. no_occluder at the node `last`, or after
// `steps_per_walk` steps.
uint next_occluder(uvec2 tree, Shaft shaft, uint last, inout uint node, inout uint steps) {
  uint found = no_occluder;
  while (found == no_occluder && node < last && steps < steps_per_walk) {
    TreeNode box = Tree(tree).at[node];
    bool met = may_meet(shaft, box);
    node = met ? node + 1u : box.skip;
    found = met ? box.occluder : no_occluder;
    ++steps;
  }
  return found;
}

#endif
