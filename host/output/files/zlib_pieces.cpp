#include "host/output/files/zlib_pieces.h"

#include <algorithm>
#include <array>
#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

namespace pmdsim {
namespace {

constexpr unsigned char low_byte(std::size_t value, unsigned shift = 0) {
  return static_cast<unsigned char>(value >> shift & 0xff);
}

} // namespace

ZlibPieces::ZlibPieces() : stream_(std::make_unique<isal_zstream>()) {}
ZlibPieces::~ZlibPieces() = default;

void ZlibPieces::begin(std::span<unsigned char> room) {
  room_ = room;
  used_ = 0;
  fits_ = true;
  put(std::to_array<unsigned char>({0x78, 0x01})); // deflate, 32 KiB of history, fastest
}

// Without history, since the pieces before may be stored: ISA-L has not seen them. Its full flush ends at a
// whole byte. Pieces are short and repeat: fixed codes, which need no table in front, make them shortest.
void ZlibPieces::add_deflated(std::span<const unsigned char> bytes) {
  const std::span<unsigned char> rest = room_.subspan(used_);
  isal_deflate_stateless_init(stream_.get());
  isal_deflate_set_hufftables(stream_.get(), nullptr, IGZIP_HUFFTABLE_STATIC);
  stream_->flush = FULL_FLUSH;
  stream_->end_of_stream = 0;
  stream_->next_in = const_cast<unsigned char *>(bytes.data()); // which it only reads
  stream_->avail_in = static_cast<std::uint32_t>(bytes.size());
  stream_->next_out = rest.data();
  stream_->avail_out = static_cast<std::uint32_t>(rest.size());
  fits_ = fits_ && isal_deflate_stateless(stream_.get()) == COMP_OK;
  used_ += stream_->total_out;
}

void ZlibPieces::add_stored(std::span<const unsigned char> bytes) {
  constexpr std::size_t most_bytes = 0xffff;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(most_bytes, bytes.size())))
    put_stored_block(false, bytes.first(std::min(most_bytes, bytes.size())));
}

std::span<const unsigned char> ZlibPieces::finish(std::span<const unsigned char> all) {
  put_stored_block(true, {});
  const std::uint32_t checksum = libdeflate_adler32(1, all.data(), all.size());
  put(std::to_array(
      {low_byte(checksum, 24), low_byte(checksum, 16), low_byte(checksum, 8), low_byte(checksum)}));
  return fits_ ? room_.first(used_) : room_.first(0);
}

void ZlibPieces::put_stored_block(bool last, std::span<const unsigned char> bytes) {
  const std::size_t count = bytes.size();
  put(std::to_array<unsigned char>(
      {low_byte(last), low_byte(count), low_byte(count, 8), low_byte(~count), low_byte(~count, 8)}));
  put(bytes);
}

void ZlibPieces::put(std::span<const unsigned char> bytes) {
  fits_ = fits_ && bytes.size() <= room_.size() - used_;
  if (!fits_)
    return;
  std::ranges::copy(bytes, room_.begin() + static_cast<std::ptrdiff_t>(used_));
  used_ += bytes.size();
}

} // namespace pmdsim
