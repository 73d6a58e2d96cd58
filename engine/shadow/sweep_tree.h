#pragma once
// The implicit tree of boxes over a board's items, as the shaders of the sweep walk it.

#include "engine/shadow/sweep_items.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pmdsim {

// Where the boxes of each level lie among all of them.
struct TreeLevels {
  std::array<std::uint32_t, shader::tree_levels> first{}, count{};
};

struct SweepTree {
  std::vector<SweepItem> items;                // whole clusters of shader::tree_width
  std::vector<std::array<glm::vec4, 2>> boxes; // low and high, level by level, each in whole clusters
  TreeLevels levels;
};

SweepTree sweep_tree(std::vector<SweepItem> items);

} // namespace pmdsim
