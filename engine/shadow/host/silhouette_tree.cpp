#include "engine/shadow/host/silhouette_tree.h"

#include "engine/shadow/item_box.h"

#include <array>
#include <bit>

namespace pmdsim {
namespace {

std::array<float, 3> unpacked_rest(std::uint32_t packed, float step) {
  std::array<float, 3> rest{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto bits = static_cast<std::int32_t>(packed << (22 - 10 * k)) >> 22; // ten bits with their sign
    rest[k] = step * static_cast<float>(bits);
  }
  return rest;
}

void put(ItemBlock &block, std::uint32_t row, std::size_t lane, const glm::vec3 &value) {
  for (std::uint32_t k = 0; k < 3; ++k)
    block.rows[row + k][lane] = std::bit_cast<std::int32_t>(value[static_cast<glm::length_t>(k)]);
}

void put_rest(ItemBlock &block, std::uint32_t row, std::size_t lane, std::uint32_t packed, float step) {
  const auto [x, y, z] = unpacked_rest(packed, step);
  put(block, row, lane, {x, y, z});
}

void put_item(const SweepItem &item, std::uint32_t number, float rest_step, ItemBlock &block,
              std::size_t lane) {
  put(block, row_ax, lane, item.a);
  put(block, row_bx, lane, item.b);
  put(block, row_cx, lane, item.first_normal);
  if (item.second == shader::item_hidden)
    put_rest(block, row_dx, lane, std::bit_cast<std::uint32_t>(item.second_normal.x), rest_step);
  else
    put(block, row_dx, lane, item.second_normal);
  put_rest(block, row_rest_ax, lane, item.first_packed, rest_step);
  put_rest(block, row_rest_bx, lane, item.second_packed, rest_step);
  block.rows[row_first][lane] = std::bit_cast<std::int32_t>(item.first);
  block.rows[row_second][lane] = std::bit_cast<std::int32_t>(item.second);
  block.rows[row_sides][lane] =
      static_cast<std::int32_t>(item.first_packed >> 30 | item.second_packed >> 30 << 2);
  block.rows[row_number][lane] = static_cast<std::int32_t>(number);
}

// Boxes around as many of those below as a block holds.
std::vector<BoxBlock> blocks_of(const std::vector<ItemBox> &boxes) {
  std::vector<BoxBlock> blocks((boxes.size() + items_per_block - 1) / items_per_block);
  for (std::size_t i = 0; i < blocks.size() * items_per_block; ++i) {
    const ItemBox &box = i < boxes.size() ? boxes[i] : empty_box;
    for (std::size_t k = 0; k < 3; ++k) {
      blocks[i / items_per_block].low[k][i % items_per_block] = box[0][static_cast<glm::length_t>(k)];
      blocks[i / items_per_block].high[k][i % items_per_block] = box[1][static_cast<glm::length_t>(k)];
    }
  }
  return blocks;
}

std::vector<ItemBox> around(const std::vector<ItemBox> &boxes) {
  std::vector<ItemBox> above((boxes.size() + items_per_block - 1) / items_per_block, empty_box);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    above[i / items_per_block] = union_of(above[i / items_per_block], boxes[i]);
  return above;
}

} // namespace

SilhouetteTree silhouette_tree(const std::vector<SweepItem> &items, float rest_step) {
  SilhouetteTree tree;
  const std::size_t count = items.size();
  if (count == 0)
    return tree;
  const SweepItem nothing{glm::vec3(1e30f), no_id, glm::vec3(1e30f), no_id,
                          glm::vec3(0.0f),  0,     glm::vec3(0.0f),  0};
  tree.items.resize((count + items_per_block - 1) / items_per_block);
  std::vector<ItemBox> boxes(tree.items.size(), empty_box);
  for (std::size_t i = 0; i < tree.items.size() * items_per_block; ++i) {
    put_item(i < count ? items[i] : nothing, static_cast<std::uint32_t>(i), rest_step,
             tree.items[i / items_per_block], i % items_per_block);
    if (i < count)
      boxes[i / items_per_block] = union_of(boxes[i / items_per_block], box_of(items[i]));
  }
  do {
    tree.levels.push_back(blocks_of(boxes));
    boxes = around(boxes);
  } while (tree.levels.back().size() > 1);
  return tree;
}

} // namespace pmdsim
