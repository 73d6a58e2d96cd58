#pragma once
// zlib's format (RFC 1950 and 1951) in pieces, of which each is deflated or stored as it is.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

struct isal_zstream;

namespace pmdsim {

// To be used again for the next stream. One thread's at a time.
class ZlibPieces {
public:
  ZlibPieces();
  ~ZlibPieces();

  // A new stream in `room`, which must live until finish().
  void begin(std::span<unsigned char> room);
  void add_deflated(std::span<const unsigned char> bytes);
  void add_stored(std::span<const unsigned char> bytes);
  // Ends the stream of what was added, `all` of it; returns its bytes, nothing where there was no room for
  // it.
  std::span<const unsigned char> finish(std::span<const unsigned char> all);

private:
  void put(std::span<const unsigned char> bytes);
  void put_stored_block(bool last, std::span<const unsigned char> bytes);

  std::unique_ptr<isal_zstream> stream_;
  std::span<unsigned char> room_;
  std::size_t used_ = 0;
  bool fits_ = true;
};

} // namespace pmdsim
