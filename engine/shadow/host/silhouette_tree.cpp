#include "engine/shadow/host/silhouette_tree.h"

#include <array>
#include <bit>

namespace pmdsim {
namespace {

using EndBox = std::array<glm::vec3, 2>;
const EndBox no_box{glm::vec3(1e30f), glm::vec3(-1e30f)};

void grow(EndBox &box, const glm::vec3 &place) { box = {glm::min(box[0], place), glm::max(box[1], place)}; }

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

EndBox box_around(const SweepItem &item) {
  EndBox box = no_box;
  grow(box, item.a);
  grow(box, item.b);
  if (item.second == shader::item_hidden)
    grow(box, item.first_normal);
  return box;
}

// Boxes around as many of those below as a block holds.
std::vector<BoxBlock> blocks_of(const std::vector<EndBox> &boxes) {
  std::vector<BoxBlock> blocks((boxes.size() + items_per_block - 1) / items_per_block);
  for (std::size_t i = 0; i < blocks.size() * items_per_block; ++i) {
    const EndBox &box = i < boxes.size() ? boxes[i] : no_box;
    for (std::size_t k = 0; k < 3; ++k) {
      blocks[i / items_per_block].low[k][i % items_per_block] = box[0][static_cast<glm::length_t>(k)];
      blocks[i / items_per_block].high[k][i % items_per_block] = box[1][static_cast<glm::length_t>(k)];
    }
  }
  return blocks;
}

std::vector<EndBox> around(const std::vector<EndBox> &boxes) {
  std::vector<EndBox> above((boxes.size() + items_per_block - 1) / items_per_block, no_box);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (const glm::vec3 &place : boxes[i])
      if (boxes[i][0].x <= boxes[i][1].x)
        grow(above[i / items_per_block], place);
  return above;
}

} // namespace

SilhouetteTree silhouette_tree(const std::vector<SweepItem> &items, float rest_step) {
  SilhouetteTree tree;
  std::size_t count = 0;
  while (count < items.size() && items[count].first != no_id) // what fills up the last cluster follows
    ++count;
  if (count == 0)
    return tree;
  const SweepItem nothing{glm::vec3(1e30f), no_id, glm::vec3(1e30f), no_id,
                          glm::vec3(0.0f),  0,     glm::vec3(0.0f),  0};
  tree.items.resize((count + items_per_block - 1) / items_per_block);
  std::vector<EndBox> boxes(tree.items.size(), no_box);
  for (std::size_t i = 0; i < tree.items.size() * items_per_block; ++i) {
    put_item(i < count ? items[i] : nothing, static_cast<std::uint32_t>(i), rest_step,
             tree.items[i / items_per_block], i % items_per_block);
    if (i < count)
      for (const glm::vec3 &place : box_around(items[i]))
        grow(boxes[i / items_per_block], place);
  }
  do {
    tree.levels.push_back(blocks_of(boxes));
    boxes = around(boxes);
  } while (tree.levels.back().size() > 1);
  return tree;
}

} // namespace pmdsim
