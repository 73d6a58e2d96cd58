#include "engine/shadow/sweep_tree.h"

#include "engine/shadow/item_box.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pmdsim {
namespace {

constexpr std::size_t width = shader::tree_width;

void fill_up(std::vector<ItemBox> &boxes, std::size_t first) {
  while ((boxes.size() - first) % width != 0)
    boxes.push_back(empty_box);
}

} // namespace

SweepTree sweep_tree(std::vector<SweepItem> items) {
  SweepTree to;
  to.items = std::move(items);
  // Items that fill up the last cluster are met by nothing.
  while (to.items.size() % width != 0 || to.items.empty())
    to.items.push_back({glm::vec3(1e30f), no_id, glm::vec3(1e30f), shader::item_boundary, glm::vec3(0.0f), 0,
                        glm::vec3(0.0f), 0});
  std::vector<ItemBox> below;
  for (const SweepItem &item : to.items)
    below.push_back(box_of(item));
  for (std::size_t level = 0; level < to.levels.first.size(); ++level) {
    const std::size_t first = to.boxes.size();
    std::vector<ItemBox> boxes;
    for (std::size_t i = 0; i < below.size(); i += width) {
      boxes.push_back(empty_box);
      for (std::size_t k = i; k < std::min(i + width, below.size()); ++k)
        boxes.back() = union_of(boxes.back(), below[k]);
    }
    to.levels.first[level] = static_cast<std::uint32_t>(first);
    to.levels.count[level] = static_cast<std::uint32_t>(boxes.size());
    to.boxes.insert(to.boxes.end(), boxes.begin(), boxes.end());
    fill_up(to.boxes, first);
    below.assign(to.boxes.begin() + static_cast<std::ptrdiff_t>(first), to.boxes.end());
  }
  return to;
}

} // namespace pmdsim
