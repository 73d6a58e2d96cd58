// Walks through the tree over the occluders.
#ifndef PMDSIM_LIT_WALK_GLSL
#define PMDSIM_LIT_WALK_GLSL

#include "occlusion.glsl"
#include "shaft.glsl"

layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Tree { TreeNode at[]; };

// The occluders of the leaf that a walk has come to; none at its end.
struct Leaf {
  uint first, count;
};

// Goes on from `node` to the next leaf in the shaft, and past it; ends at the node `last` or after `steps_per_walk` steps.
Leaf next_leaf(uvec2 tree, Shaft shaft, uint last, inout uint node, inout uint steps) {
  while (node < last && steps < steps_per_walk) {
    TreeNode box = Tree(tree).at[node];
    ++steps;
    bool met = may_meet(shaft, vec3(box.low_x, box.low_y, box.low_z), vec3(box.high_x, box.high_y, box.high_z));
    node = met ? node + 1u : box.skip;
    if (met && box.occluders != 0u)
      return Leaf(box.occluders >> 3, box.occluders & 7u);
  }
  return Leaf(0u, 0u);
}

#endif
