#include "engine/multipath/image_cells.h"

#include <algorithm>

namespace pmdsim {
namespace {

// The runs of a row that see one surface each.
std::vector<Run> runs_of(const SeenPlaces &seen, std::uint32_t row, std::uint32_t low, std::uint32_t high) {
  std::vector<Run> runs;
  for (std::uint32_t column = low; column <= high; ++column) {
    if (seen.shape({column, row}) == no_id)
      continue;
    if (!runs.empty() && runs.back().high + 1 == column &&
        seen.are_continuous({column - 1, row}, {column, row}))
      runs.back().high = column;
    else
      runs.push_back({column, column});
  }
  return runs;
}

bool owns_any(const ImageCell &cell) {
  return (cell.owns_last_row || cell.runs.size() > 1) &&
         (cell.owns_last_column ||
          std::ranges::any_of(cell.runs, [](const Run &run) { return run.high > run.low; }));
}

bool overlap(const Run &a, const Run &b) { return a.low <= b.high && b.low <= a.high; }

} // namespace

bool ImageCell::has_middle_column() const {
  return std::ranges::any_of(runs, [](const Run &run) { return run.high - run.low > 1; });
}

std::array<float, 2> ImageCell::place_in(const glm::uvec2 &sample) const {
  const Run &run = runs[sample.y - row];
  const auto part = [](std::uint32_t at, std::uint32_t low, std::uint32_t high) {
    return high > low ? static_cast<float>(at - low) / static_cast<float>(high - low) : 0.0f;
  };
  return {part(sample.x, run.low, run.high), part(sample.y, row, last_row())};
}

std::array<float, 4> ImageCell::weights(const glm::uvec2 &sample) const {
  const auto [x, y] = place_in(sample);
  return {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
}

float ImageCell::bend(const glm::uvec2 &sample) const {
  const auto bent = [&](const glm::uvec2 &at) {
    const auto [x, y] = place_in(at);
    return x * (1 - x) + y * (1 - y);
  };
  const float most = bent(middle());
  return most > 0.0f ? bent(sample) / most : 0.0f;
}

std::vector<ImageCell> cells_of(const SeenPlaces &seen, const glm::uvec2 &low, const glm::uvec2 &high) {
  std::vector<ImageCell> closed, open;
  const bool is_lowest = high.y + 1 == seen.rows(), is_rightmost = high.x + 1 == seen.columns();
  const auto close = [&](ImageCell &&done) {
    // A last row inside the block has nobody else to own it.
    done.owns_last_row = done.last_row() < high.y || is_lowest;
    if (owns_any(done))
      closed.push_back(std::move(done));
  };
  for (std::uint32_t row = low.y; row <= high.y; ++row) {
    std::vector<ImageCell> next;
    std::vector<std::uint8_t> taken(open.size());
    for (const Run &run : runs_of(seen, row, low.x, high.x)) {
      const auto continues = [&](const ImageCell &above) {
        const std::uint32_t column = std::max(above.runs.back().low, run.low);
        return overlap(above.runs.back(), run) && seen.are_continuous({column, row - 1}, {column, row}) &&
               above.owns_last_column == (run.high < high.x || is_rightmost);
      };
      const auto above = std::ranges::find_if(open, continues);
      if (above != open.end() && !taken[static_cast<std::size_t>(above - open.begin())]) {
        taken[static_cast<std::size_t>(above - open.begin())] = 1;
        next.push_back(*above);
        next.back().runs.push_back(run);
      } else {
        next.push_back({row, {run}, false, run.high < high.x || is_rightmost});
      }
    }
    for (std::size_t i = 0; i < open.size(); ++i)
      if (!taken[i])
        close(std::move(open[i]));
    open = std::move(next);
  }
  for (ImageCell &last : open)
    close(std::move(last));
  return closed;
}

std::array<ImageCell, 2> halves_by_row(const ImageCell &cell) {
  const auto middle = static_cast<std::ptrdiff_t>((cell.runs.size() - 1) / 2);
  std::array<ImageCell, 2> halves{cell, cell};
  halves[0].runs.assign(cell.runs.begin(), cell.runs.begin() + middle + 1);
  halves[0].owns_last_row = false;
  halves[1].runs.assign(cell.runs.begin() + middle, cell.runs.end());
  halves[1].row += static_cast<std::uint32_t>(middle);
  return halves;
}

std::array<ImageCell, 2> halves_by_column(const ImageCell &cell) {
  std::array<ImageCell, 2> halves{cell, cell};
  for (std::size_t i = 0; i < cell.runs.size(); ++i)
    halves[0].runs[i].high = halves[1].runs[i].low = cell.runs[i].middle();
  halves[0].owns_last_column = false;
  return halves;
}

} // namespace pmdsim
