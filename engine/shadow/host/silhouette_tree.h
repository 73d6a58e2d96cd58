#pragma once
// The tree over a board's items as the host's sweep walks it.

#include "engine/shadow/host/silhouettes.h"
#include "engine/shadow/sweep_items.h"

#include <cstddef>
#include <vector>

namespace pmdsim {

// An ItemTree and the memory that it lies in.
struct SilhouetteTree {
  std::vector<ItemBlock> items;
  std::vector<std::vector<BoxBlock>> levels;

  ItemTree view() const {
    ItemTree tree;
    tree.items = items.data();
    tree.blocks = static_cast<std::uint32_t>(items.size());
    tree.levels = static_cast<std::uint32_t>(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i)
      tree.boxes[i] = levels[i].data();
    return tree;
  }
};

// `rest_step`: of the items' packed rests, m.
SilhouetteTree silhouette_tree(const std::vector<SweepItem> &items, float rest_step);

} // namespace pmdsim
