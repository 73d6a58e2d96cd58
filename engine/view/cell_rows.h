#pragma once
// Cells of a raster, a fragment each, row by row: sets of them, and those that outlines cover.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace pmdsim {

// A convex polygon of up to four corners on a raster, or a line, of two.
struct Outline {
  std::array<glm::dvec2, 4> corners;
  std::size_t count = 0;

  void add(const glm::dvec2 &corner) { corners[count++] = corner; }
};

// Rows, or columns of a row, both ends included; none where the last comes before the first.
struct CellSpan {
  std::int64_t first = 0, last = -1;
};

constexpr double cell_margin = 1.0 / 64.0; // fragments

// The rows of a raster of `size` cells that an outline touches, the columns of a row that it touches, and
// those whose cells lie inside it altogether. Cells are taken larger by the margin, which is more than a
// float errs by in telling in which of them a place of the raster lies.
class OutlineCells {
public:
  OutlineCells(const Outline &outline, const glm::uvec2 &size);

  const CellSpan &rows() const { return rows_; }
  // The columns of all its rows together.
  const CellSpan &columns() const { return columns_; }
  CellSpan touched(std::int64_t row) const;
  CellSpan inside(std::int64_t row) const;

private:
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

    void take(double place) {
      low = std::min(low, place);
      high = std::max(high, place);
    }
  };
  struct Edge {
    glm::dvec2 top, bottom;
    double slope; // columns a row, where it crosses rows

    double column_at(double y) const { return top.x + (y - top.y) * slope; }
  };
  Range columns_between(double y_low, double y_high) const;

  std::array<Edge, 4> edges_;
  std::size_t edge_count_;
  glm::uvec2 size_;
  CellSpan rows_, columns_;
};

class CellSet {
public:
  explicit CellSet(const glm::uvec2 &size)
      : words_per_row_((size.x + 63) / 64), words_(std::size_t{words_per_row_} * size.y) {}

  void add(std::int64_t row, const CellSpan &columns) {
    for (std::int64_t column = columns.first; column <= columns.last; ++column)
      words_[word_at(row, column)] |= std::uint64_t{1} << (column % 64);
  }
  // Once all are added: numbers them row by row. Returns how many there are.
  std::uint32_t number();
  bool has_any(std::int64_t row, const CellSpan &columns) const;

  // Calls `take` with the number and the column of each among the columns.
  template <typename Take>
  void for_each(std::int64_t row, const CellSpan &columns, const Take &take) const {
    if (columns.last < columns.first)
      return;
    const std::size_t last = word_at(row, columns.last);
    for (std::size_t at = word_at(row, columns.first); at <= last; ++at)
      for (std::uint64_t left = within(at, row, columns); left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const auto before =
            static_cast<std::uint32_t>(std::popcount(words_[at] & ((std::uint64_t{1} << bit) - 1)));
        take(numbers_[at] + before,
             static_cast<std::uint32_t>((at - word_at(row, 0)) * 64) + static_cast<std::uint32_t>(bit));
      }
  }

private:
  std::size_t word_at(std::int64_t row, std::int64_t column) const {
    return static_cast<std::size_t>(row) * words_per_row_ + static_cast<std::size_t>(column / 64);
  }
  std::uint64_t within(std::size_t at, std::int64_t row, const CellSpan &columns) const;

  std::uint32_t words_per_row_;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> numbers_; // of the first one of each word
};

} // namespace pmdsim
