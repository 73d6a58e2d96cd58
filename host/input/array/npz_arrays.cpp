#include "host/input/array/array_formats.h"

#include "host/input/file/memory_request.h"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>
#include <memory>
#include <new>

namespace pmdsim {
namespace {

constexpr std::string_view ending = ".npy";
// Deflate makes at most 1032 bytes of one.
constexpr std::size_t most_of_a_byte = 1032;
constexpr std::size_t most_arrays = 65'535; // as many as a ZIP file has without extensions

struct Free {
  void operator()(archive *of) const { archive_read_free(of); }
};
using Archive = std::unique_ptr<archive, Free>;

class NpzReader {
public:
  NpzReader(std::string_view bytes, const Place &place)
      : place_(place), most_bytes_(bytes.size() * most_of_a_byte), archive_(archive_read_new()) {
    if (!archive_)
      throw std::bad_alloc();
    check(archive_read_support_format_zip(archive_.get()));
    check(archive_read_open_memory(archive_.get(), bytes.data(), bytes.size()));
  }

  // The next array's name; nothing at the end.
  std::optional<std::string> next() {
    archive_entry *entry = nullptr;
    for (;;) {
      const int result = archive_read_next_header(archive_.get(), &entry);
      if (result == ARCHIVE_EOF)
        return std::nullopt;
      check(result);
      const char *path = archive_entry_pathname(entry);
      const std::string_view name = path ? path : "";
      if (archive_entry_filetype(entry) == AE_IFREG && name.ends_with(ending))
        return std::string(name.substr(0, name.size() - ending.size()));
    }
  }

  // Of the array that next() has named. Grows with what is there, whatever the archive says of sizes.
  std::string bytes() {
    std::string bytes;
    const void *block = nullptr;
    std::size_t size = 0;
    la_int64_t offset = 0;
    for (int result = 0;
         (result = archive_read_data_block(archive_.get(), &block, &size, &offset)) != ARCHIVE_EOF;) {
      check(result);
      if (offset != static_cast<la_int64_t>(bytes.size()) || size > most_bytes_)
        throw input_error(place_, "expected arrays without gaps, and no more than the file can hold");
      most_bytes_ -= size;
      if (bytes.size() + size > bytes.capacity())
        require_memory(2 * (bytes.size() + size), place_, "an array of it");
      bytes.append(static_cast<const char *>(block), size);
    }
    return bytes;
  }

private:
  void check(int result) const {
    if (result == ARCHIVE_OK)
      return;
    const char *reason = archive_error_string(archive_.get());
    throw input_error(place_,
                      fmt::format("no valid NPZ: {}", reason ? reason : "libarchive gives no reason"));
  }

  const Place &place_;
  std::size_t most_bytes_;
  Archive archive_;
};

} // namespace

ImageArrays npz_arrays(std::string_view bytes, const std::function<bool(std::string_view)> &wanted,
                       const Place &place) {
  ImageArrays read{"NPZ"};
  NpzReader reader(bytes, place);
  while (const std::optional<std::string> name = reader.next()) {
    if (read.names.size() == most_arrays)
      throw input_error(place, fmt::format("expected at most {} arrays", most_arrays));
    read.names.push_back(*name);
    if (!wanted(*name))
      continue;
    const std::string content = reader.bytes();
    if (!content.starts_with(npy_magic))
      throw input_error(place, fmt::format("array {}: expected NPY", in_quotes(*name)));
    read.arrays.push_back(npy_array(content, place));
    read.arrays.back().name = *name;
  }
  return read;
}

} // namespace pmdsim
