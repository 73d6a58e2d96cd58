#include "host/output/files/zip_block.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace pmdsim {
namespace {

std::uint32_t value_at(const unsigned char *row, std::size_t column) {
  std::uint32_t value = 0;
  std::memcpy(&value, row + column * sizeof value, sizeof value);
  return value;
}

// Whether most values are those to their left.
bool is_repetitive(const unsigned char *row, std::size_t columns) {
  std::uint32_t same = 0;
  for (std::size_t x = 1; x < columns; ++x)
    same += value_at(row, x) == value_at(row, x - 1) ? 1U : 0U;
  return 2 * std::size_t{same} >= columns;
}

// Writes to `out` how much more every second byte of `row` is than the one before, with `before` in front of
// the first; returns the last byte.
unsigned char differences(const unsigned char *__restrict row, std::size_t count, unsigned char before,
                          unsigned char *__restrict out) {
  constexpr unsigned zero = 128;
  out[0] = static_cast<unsigned char>(row[0] - before + zero);
  for (std::size_t i = 1; i < count; ++i)
    out[i] = static_cast<unsigned char>(row[2 * i] - row[2 * i - 2] + zero);
  return row[2 * count - 2];
}

} // namespace

ZipBlock::ZipBlock(const ScanLines &lines) : lines_(lines) {
  const std::size_t rows = std::min(most_rows, lines.rows) * lines.channels.size();
  differences_ = std::make_unique_for_overwrite<unsigned char[]>(rows * lines.row_bytes);
  packed_ = std::make_unique_for_overwrite<unsigned char[]>(rows * lines.row_bytes);
  repetitive_.resize(rows);
}

std::span<const unsigned char> ZipBlock::pack(std::size_t first_row) {
  const std::size_t end_row = std::min(first_row + most_rows, lines_.rows);
  const auto packed = zipped(first_row, end_row);
  return packed.empty() ? rows_themselves(first_row, end_row) : packed;
}

// Nothing where that is not shorter than the rows.
std::span<const unsigned char> ZipBlock::zipped(std::size_t first_row, std::size_t end_row) {
  const std::size_t rows = (end_row - first_row) * lines_.channels.size(), row_half = lines_.row_bytes / 2;
  const std::span all(differences_.get(), rows * lines_.row_bytes);
  split(first_row, end_row, all.size());
  zlib_.begin({packed_.get(), all.size() - 1});
  for (std::size_t begin = 0, end = 0; begin < 2 * rows; begin = end) {
    const bool repetitive = repetitive_[begin % rows];
    for (end = begin + 1; end < 2 * rows && repetitive_[end % rows] == repetitive; ++end) {
    }
    const auto piece = all.subspan(begin * row_half, (end - begin) * row_half);
    repetitive ? zlib_.add_deflated(piece) : zlib_.add_stored(piece);
  }
  return zlib_.finish(all);
}

std::span<const unsigned char> ZipBlock::rows_themselves(std::size_t first_row, std::size_t end_row) {
  unsigned char *out = packed_.get();
  for (std::size_t y = first_row; y < end_row; ++y)
    for (const unsigned char *channel : lines_.channels)
      out = std::copy_n(channel + y * lines_.row_bytes, lines_.row_bytes, out);
  return {packed_.get(), out};
}

// First the even bytes of all rows, then the odd ones. Differences go on from row to row and from one half to
// the other; the very first byte stands for itself.
void ZipBlock::split(std::size_t first_row, std::size_t end_row, std::size_t bytes) {
  const std::size_t row_bytes = lines_.row_bytes, row_half = row_bytes / 2;
  unsigned char *even = differences_.get(), *odd = even + bytes / 2;
  unsigned char last_even = 0, last_odd = lines_.channels.back()[end_row * row_bytes - 2];
  std::size_t row_number = 0;
  for (std::size_t y = first_row; y < end_row; ++y)
    for (const unsigned char *channel : lines_.channels) {
      const unsigned char *row = channel + y * row_bytes;
      repetitive_[row_number++] = is_repetitive(row, row_bytes / sizeof(std::uint32_t));
      last_even = differences(row, row_half, last_even, even);
      last_odd = differences(row + 1, row_half, last_odd, odd);
      even += row_half;
      odd += row_half;
    }
  differences_[0] = lines_.channels.front()[first_row * row_bytes];
}

} // namespace pmdsim
