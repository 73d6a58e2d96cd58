#include "engine/view/cell_rows.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace pmdsim {
namespace {

// The cells that the range touches; also of ranges far off, whose ends no integer holds.
CellSpan cells_of(double low, double high, std::uint32_t count) {
  const double last = count - 1.0;
  return {static_cast<std::int64_t>(std::clamp(std::floor(low - cell_margin), 0.0, last + 1.0)),
          static_cast<std::int64_t>(std::clamp(std::floor(high + cell_margin), -1.0, last))};
}

} // namespace

OutlineCells::OutlineCells(const Outline &outline, const glm::uvec2 &size)
    : edge_count_(outline.count), size_(size) {
  Range x, y;
  for (std::size_t i = 0; i < outline.count; ++i) {
    const glm::dvec2 &a = outline.corners[i], &b = outline.corners[i + 1 < outline.count ? i + 1 : 0];
    const auto [top, bottom] = a.y <= b.y ? std::pair(a, b) : std::pair(b, a);
    edges_[i] = {top, bottom, (bottom.x - top.x) / (bottom.y - top.y)};
    x.take(a.x);
    y.take(a.y);
  }
  if (outline.count > 0) {
    rows_ = cells_of(y.low, y.high, size.y);
    columns_ = cells_of(x.low, x.high, size.x);
  }
}

OutlineCells::Range OutlineCells::columns_between(double y_low, double y_high) const {
  Range x;
  for (const Edge &edge : std::span(edges_).first(edge_count_)) {
    if (edge.bottom.y < y_low || edge.top.y > y_high)
      continue;
    x.take(edge.top.y >= y_low ? edge.top.x : edge.column_at(y_low));
    x.take(edge.bottom.y <= y_high ? edge.bottom.x : edge.column_at(y_high));
  }
  return x;
}

CellSpan OutlineCells::touched(std::int64_t row) const {
  const auto top = static_cast<double>(row);
  const Range x = columns_between(top - cell_margin, top + 1.0 + cell_margin);
  return x.low > x.high ? CellSpan() : cells_of(x.low, x.high, size_.x);
}

CellSpan OutlineCells::inside(std::int64_t row) const {
  const double above = static_cast<double>(row) - cell_margin,
               below = static_cast<double>(row) + 1.0 + cell_margin;
  const Range upper = columns_between(above, above), lower = columns_between(below, below);
  const double low = std::max(upper.low, lower.low) + cell_margin,
               high = std::min(upper.high, lower.high) - cell_margin;
  if (!(high - low >= 1.0))
    return {};
  const double columns = size_.x;
  return {static_cast<std::int64_t>(std::clamp(std::ceil(low), 0.0, columns)),
          static_cast<std::int64_t>(std::clamp(std::floor(high) - 1.0, -1.0, columns - 1.0))};
}

std::uint32_t CellSet::number() {
  std::uint32_t count = 0;
  numbers_.clear();
  numbers_.reserve(words_.size());
  for (const std::uint64_t word : words_) {
    numbers_.push_back(count);
    count += static_cast<std::uint32_t>(std::popcount(word));
  }
  return count;
}

bool CellSet::has_any(std::int64_t row, const CellSpan &columns) const {
  if (columns.last < columns.first)
    return false;
  const std::size_t last = word_at(row, columns.last);
  for (std::size_t at = word_at(row, columns.first); at <= last; ++at)
    if (within(at, row, columns) != 0)
      return true;
  return false;
}

std::uint64_t CellSet::within(std::size_t at, std::int64_t row, const CellSpan &columns) const {
  std::uint64_t word = words_[at];
  if (at == word_at(row, columns.first))
    word &= ~std::uint64_t{0} << (columns.first % 64);
  if (at == word_at(row, columns.last))
    word &= ~std::uint64_t{0} >> (63 - columns.last % 64);
  return word;
}

} // namespace pmdsim
