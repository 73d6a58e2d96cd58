#pragma once
// Lists of the items that matter to some samples: of a tree's blocks first, then of the items beside each
// other.

#include "engine/shadow/host/ways.h"

#include <bit>
#include <cstdint>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {

constexpr int segment = 512; // items at a time

// The rows that tell whether items matter lie in other parts of memory for each block.
inline void fetch_soon(const ItemTree &tree, std::uint32_t first, std::uint32_t blocks) {
  for (; blocks != 0; blocks &= blocks - 1) {
    const ItemBlock &block = tree.items[first + static_cast<std::uint32_t>(std::countr_zero(blocks))];
    for (std::uint32_t row = row_ax; row <= row_dz; ++row)
      __builtin_prefetch(block.rows[row]);
  }
}

// Lists the items that matter, block by block; returns how many blocks there are.
template <class Matters>
std::uint32_t list_items(const ItemTree &tree, const Ways &ways, Matters matters, ListedBlock *listed) {
  if (tree.blocks == 0)
    return 0;
  struct Step {
    std::uint32_t level, block;
  } stack[most_box_levels * items_per_block + 1];
  int depth = 0;
  std::uint32_t found = 0;
  stack[depth++] = {tree.levels - 1, 0};
  while (depth > 0) {
    const Step step = stack[--depth];
    std::uint32_t met = meet(ways, tree.boxes[step.level][step.block]);
    if (step.level == 0)
      fetch_soon(tree, step.block * items_per_block, met);
    for (; met != 0; met &= met - 1) {
      const std::uint32_t below =
          step.block * items_per_block + static_cast<std::uint32_t>(std::countr_zero(met));
      if (step.level > 0) {
        stack[depth++] = {step.level - 1, below};
        continue;
      }
      std::uint32_t bits = 0;
      const Rows items = rows_of(tree.items[below]);
      for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
        bits |= bits_of(matters(ways, items, i)) << i;
      listed[found] = {below, bits};
      found += bits != 0 ? 1 : 0;
    }
  }
  return found;
}

// Those of the listed items that matter to fewer samples, likewise.
template <class Matters>
std::uint32_t narrow(const ItemTree &tree, const ListedBlock *from, std::uint32_t count, const Ways &ways,
                     Matters matters, ListedBlock *to) {
  std::uint32_t found = 0;
  for (std::uint32_t entry = 0; entry < count; ++entry) {
    std::uint32_t bits = 0;
    const Rows items = rows_of(tree.items[from[entry].block]);
    for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
      bits |= bits_of(matters(ways, items, i)) << i;
    bits &= from[entry].bits;
    to[found] = {from[entry].block, bits};
    found += bits != 0 ? 1 : 0;
  }
  return found;
}

// Some items, beside each other.
struct ItemList {
  alignas(64) std::int32_t rows[item_rows][segment + lanes];
  int count;

  Rows all() const { return {&rows[0][0], segment + lanes}; }

  void add(const Rows &from, int i, std::uint32_t bits) {
    if (bits == 0)
      return;
    const Packing packed(bits);
    for (int row = 0; row < static_cast<int>(item_rows); ++row)
      store(rows[row] + count, packed(from.ints(row, i)));
    count += packed.count();
  }
};

// Gathers the items of as many of the listed blocks as fit; returns the first block that did not.
inline std::uint32_t gather(const ItemTree &tree, const ListedBlock *listed, std::uint32_t first,
                            std::uint32_t end, ItemList &to) {
  to.count = 0;
  for (; first < end && to.count + static_cast<int>(items_per_block) <= segment; ++first)
    for (int i = 0; i < static_cast<int>(items_per_block); i += lanes)
      to.add(rows_of(tree.items[listed[first].block]), i,
             listed[first].bits >> i & ((std::uint32_t{1} << lanes) - 1u));
  return first;
}

template <class Matters>
void narrow(const ItemList &from, const Ways &ways, Matters matters, ItemList &to) {
  to.count = 0;
  for (int i = 0; i < from.count; i += lanes) {
    const std::uint32_t there = from.count - i < lanes ? (1u << (from.count - i)) - 1u : ~0u;
    to.add(from.all(), i, bits_of(matters(ways, from.all(), i)) & there);
  }
}

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
