#include "engine/shadow/place_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <numeric>

namespace pmdsim {
namespace {

std::uint32_t spread_bits(std::uint32_t v) {
  v = (v | v << 16) & 0x030000ffu;
  v = (v | v << 8) & 0x0300f00fu;
  v = (v | v << 4) & 0x030c30c3u;
  return (v | v << 2) & 0x09249249u;
}

struct Coded {
  std::uint32_t code, place;
};

constexpr std::uint32_t digit_bits = 10;

// Codes of the same digit stay in their order.
void sort_by_digit(const std::vector<Coded> &codes, std::uint32_t shift, std::vector<Coded> &sorted) {
  constexpr std::uint32_t digits = 1u << digit_bits;
  const auto digit_of = [&](const Coded &coded) { return coded.code >> shift & (digits - 1); };
  std::array<std::size_t, digits + 1> next{};
  for (const Coded &coded : codes)
    ++next[digit_of(coded) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (const Coded &coded : codes)
    sorted[next[digit_of(coded)]++] = coded;
}

} // namespace

std::vector<std::uint32_t> order_by_place(const std::vector<glm::dvec3> &places_m) {
  glm::dvec3 low_m(std::numeric_limits<double>::infinity()), high_m = -low_m;
  for (const glm::dvec3 &place_m : places_m) {
    low_m = glm::min(low_m, place_m);
    high_m = glm::max(high_m, place_m);
  }
  const glm::dvec3 scale = 1023.0 / glm::max(high_m - low_m, glm::dvec3(1e-9));
  std::vector<Coded> codes(places_m.size()), sorted(places_m.size());
  for (std::uint32_t i = 0; i < places_m.size(); ++i) {
    const glm::uvec3 at((places_m[i] - low_m) * scale);
    codes[i] = {spread_bits(at.x) | spread_bits(at.y) << 1 | spread_bits(at.z) << 2, i};
  }
  for (std::uint32_t shift = 0; shift < 30; shift += digit_bits) {
    sort_by_digit(codes, shift, sorted);
    codes.swap(sorted);
  }
  std::vector<std::uint32_t> order(codes.size());
  std::ranges::transform(codes, order.begin(), &Coded::place);
  return order;
}

} // namespace pmdsim
