#pragma once
// Boxes around items of the sweep, for the trees over them.

#include "engine/shadow/sweep_items.h"

#include <array>

namespace pmdsim {

// Low and high, board frame, m; w is 0.
using ItemBox = std::array<glm::vec4, 2>;

// Met by nothing, and of no weight in a union.
inline const ItemBox empty_box{glm::vec4(1e30f), glm::vec4(-1e30f)};

inline ItemBox union_of(const ItemBox &a, const ItemBox &b) {
  return {glm::min(a[0], b[0]), glm::max(a[1], b[1])};
}

inline ItemBox box_of(const SweepItem &item) {
  const glm::vec4 a(item.a, 0.0f), b(item.b, 0.0f), c(item.first_normal, 0.0f);
  const ItemBox of_ends{glm::min(a, b), glm::max(a, b)};
  return item.second == shader::item_hidden ? union_of(of_ends, {c, c}) : of_ends;
}

} // namespace pmdsim
