#pragma once
// Parts of a frame, one sample or more, whose samples see one surface that is flat or smooth: between their
// corners what arrives there is interpolated, so none reaches over an edge.

#include "engine/multipath/seen_places.h"

#include <array>
#include <cstdint>
#include <vector>

namespace pmdsim {

// Columns from `low` to `high`, both included.
struct Run {
  std::uint32_t low, high;

  std::uint32_t middle() const { return (low + high) / 2; }
};

// One run of each row from `row` on. Its last row and the last column of each row may belong to the
// neighbour.
struct ImageCell {
  std::uint32_t row = 0;
  std::vector<Run> runs;
  bool owns_last_row = false, owns_last_column = false;

  std::uint32_t last_row() const { return row + static_cast<std::uint32_t>(runs.size()) - 1; }
  // Low and high of the first row, then of the last.
  std::array<glm::uvec2, 4> corners() const {
    return {{{runs.front().low, row},
             {runs.front().high, row},
             {runs.back().low, last_row()},
             {runs.back().high, last_row()}}};
  }
  glm::uvec2 middle() const {
    const std::size_t half = (runs.size() - 1) / 2;
    return {runs[half].middle(), row + static_cast<std::uint32_t>(half)};
  }
  // Whether it has samples that are no corners of it.
  bool is_divisible() const { return has_middle_row() || has_middle_column(); }
  bool has_middle_row() const { return runs.size() > 2; }
  bool has_middle_column() const;
  // How much each corner counts at a sample of it.
  std::array<float, 4> weights(const glm::uvec2 &sample) const;
  // How far a function that bends as much along rows as along columns is off there from what corners tell, as
  // a part of what it is off in the middle.
  float bend(const glm::uvec2 &sample) const;

private:
  // From the first column to the last, and from the first row to the last: 0 to 1.
  std::array<float, 2> place_in(const glm::uvec2 &sample) const;
};

// The cells of the samples from `low` to `high`, both included; those at `high` belong to the neighbours
// where there are any.
std::vector<ImageCell> cells_of(const SeenPlaces &seen, const glm::uvec2 &low, const glm::uvec2 &high);

// Halves of a cell, which share the row or the columns in its middle.
std::array<ImageCell, 2> halves_by_row(const ImageCell &cell);
std::array<ImageCell, 2> halves_by_column(const ImageCell &cell);

// Calls visit(sample) for each that is a cell's own.
template <class Visit>
void for_each_own(const ImageCell &cell, const Visit &visit) {
  const std::size_t rows = cell.runs.size() - (cell.owns_last_row ? 0 : 1);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::uint32_t column = cell.runs[i].low;
         column + (cell.owns_last_column ? 0 : 1) <= cell.runs[i].high; ++column)
      visit(glm::uvec2(column, cell.row + i));
}

} // namespace pmdsim
