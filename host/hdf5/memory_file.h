#pragma once
// HDF5 files that lie in memory, to be read.

#include "host/hdf5/hdf5.h"

#include <cstddef>
#include <string_view>

namespace pmdsim {

// An open file, in a Hdf5Turn; its id is below 0 where the bytes, which must outlive it, are none. HDF5's own
// driver of files in memory lets it gather small reads, for which 1.10 trusts addresses of damaged files;
// this one does not, and refuses whatever lies beyond the bytes. What HDF5 fails to close of a damaged file
// reads nothing any more.
class Hdf5MemoryFile {
public:
  explicit Hdf5MemoryFile(std::string_view bytes);
  ~Hdf5MemoryFile();
  Hdf5MemoryFile(const Hdf5MemoryFile &) = delete;
  Hdf5MemoryFile &operator=(const Hdf5MemoryFile &) = delete;

  hid_t id() const { return file_.id(); }

  // How many bytes HDF5 has read of datasets' values since the file was opened. A damaged index of chunks has
  // other sizes for them than HDF5 tells of, and reads as many as the index has.
  std::size_t value_bytes_read() const { return content_.value_bytes_read; }

  struct Content {
    std::string_view bytes;
    std::size_t value_bytes_read = 0;
  };

private:
  Content content_;   // has its place for HDF5's driver as long as the file
  Hdf5Handle access_; // closed last, as HDF5 forgets why it failed when it closes anything
  Hdf5Handle file_;
};

} // namespace pmdsim
