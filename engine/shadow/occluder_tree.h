#pragma once
// The bounding volume hierarchy over the occluders, laid out in the order of a walk that needs no stack.

#include "shaders/shadow/lit_interface.h"

#include <vector>

namespace pmdsim {

struct OccluderTree {
  std::vector<shader::TreeNode> nodes;
  std::vector<shader::Occluder> occluders; // in the order of the leaves
};

// Throws Error (out_of_memory).
OccluderTree build_tree(const std::vector<shader::Occluder> &occluders);

} // namespace pmdsim
