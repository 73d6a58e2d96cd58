#include "engine/shadow/place_order.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pmdsim {
namespace {

std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000ffu;
  v = (v | v << 8) & 0x0300f00fu;
  v = (v | v << 4) & 0x030c30c3u;
  return (v | v << 2) & 0x09249249u;
}

} // namespace

std::vector<std::uint32_t> order_by_place(const std::vector<glm::dvec3> &places_m) {
  glm::dvec3 low_m(std::numeric_limits<double>::infinity()), high_m = -low_m;
  for (const glm::dvec3 &place_m : places_m) {
    low_m = glm::min(low_m, place_m);
    high_m = glm::max(high_m, place_m);
  }
  const glm::dvec3 scale = 1023.0 / glm::max(high_m - low_m, glm::dvec3(1e-9));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> codes;
  for (std::uint32_t i = 0; i < places_m.size(); ++i) {
    const glm::uvec3 at((places_m[i] - low_m) * scale);
    codes.emplace_back(spread_bits(at.x) | spread_bits(at.y) << 1 | spread_bits(at.z) << 2, i);
  }
  std::ranges::sort(codes);
  std::vector<std::uint32_t> order;
  for (const auto &[code, i] : codes)
    order.push_back(i);
  return order;
}

} // namespace pmdsim
