#pragma once
// A block of rows as OpenEXR's ZIP compression has it. Source: OpenEXR 3.1's file layout and its Zip class.

#include "host/output/files/zlib_pieces.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace pmdsim {

// A view: the first row of each channel, in the order of the file; values have four bytes.
struct ScanLines {
  std::vector<const unsigned char *> channels;
  std::size_t row_bytes = 0; // of one channel
  std::size_t rows = 0;
};

// Room for one block at a time, twice the block's bytes, to be used again for the next. Rows of which most
// values repeat, as those of ids and shares do, are compressed; other rows are stored as they are. Mantissas
// of measured floats hardly shrink, and to try it takes most of the time: docs/decisions.md, "What an EXR
// file compresses".
class ZipBlock {
public:
  static constexpr std::size_t most_rows = 16; // as many as each has, but for a file's last

  // For blocks of `lines`, which must outlive it.
  explicit ZipBlock(const ScanLines &lines);

  // The block that begins at that row; valid until the next call. As ZIP has it, that is the rows themselves
  // where compression would not make them shorter.
  std::span<const unsigned char> pack(std::size_t first_row);

private:
  std::span<const unsigned char> zipped(std::size_t first_row, std::size_t end_row);
  std::span<const unsigned char> rows_themselves(std::size_t first_row, std::size_t end_row);
  void split(std::size_t first_row, std::size_t end_row, std::size_t bytes);

  const ScanLines &lines_;
  std::unique_ptr<unsigned char[]> differences_, packed_;
  std::vector<bool> repetitive_; // of each row of each channel
  ZlibPieces zlib_;
};

} // namespace pmdsim
