#pragma once
// One file that is written whole or not at all: under a temporary name in the same directory, then renamed.

#include "engine/model/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace pmdsim {

enum class Lacking { memory, other };

// Why a file was not written, in one line: Error (out_of_memory) where it lacked memory, Error (output)
// otherwise.
Error write_error(const std::filesystem::path &path, const std::string &reason, Lacking lacking);
Error write_error(const std::filesystem::path &path, int error_number);

// Life: construct, write, close (flushed to the operating system), publish (renamed; an existing file is
// replaced). The temporary is removed when an OutputFile dies unpublished. Every failure throws Error
// (output) that names the final path and the operating system's reason.
//
// Whole or not at all holds against every failure, and against a program that is killed. Against a power cut
// it holds where the disk has the file before it gets its name: by sync(), or by sync_file_system() for many
// files at once.
//
// Each is one thread's at a time.
class OutputFile {
public:
  // Creates the temporary beside `path`; the directory must exist.
  explicit OutputFile(std::filesystem::path path);
  ~OutputFile();
  OutputFile(const OutputFile &) = delete;
  OutputFile &operator=(const OutputFile &) = delete;

  const std::filesystem::path &path() const { return path_; }

  // Reserves the file's whole length, where it is known before anything is written: it is found out at once
  // whether the disk has room, and the writing takes about half as long.
  void reserve(std::uint64_t bytes);
  // Many bytes at once go past the page cache where the system can (Linux 6.14), which a sequence would fill.
  void write(std::string_view bytes);
  void seek(std::uint64_t offset);
  std::uint64_t tell() const;

  // Returns when the disk has what was written, which takes milliseconds.
  void sync();
  // Reports what failed in any earlier write too, even where a library swallowed the exception.
  void close();
  // Throws what can be foreseen of publish(): that the name belongs to a directory.
  void check_publishable() const;
  void publish();
  // Of the closed file.
  std::uint64_t size_bytes() const { return size_bytes_; }
  // Takes a published file back; for when a later file of the same set fails.
  void withdraw() noexcept;

private:
  [[noreturn]] void fail(int error_number) const;
  [[noreturn]] void fail_for_good(); // by errno, or what came before it
  // How many of the first bytes are written then.
  std::size_t write_uncached(std::string_view bytes);

  std::filesystem::path path_;
  std::filesystem::path temporary_; // empty once renamed or removed
  std::FILE *stream_ = nullptr;     // null once closed
  std::uint64_t size_bytes_ = 0;
  int first_error_ = 0; // errno of the first write that failed
};

// Throws Error (output) where a device, a pipe or a socket is in the place of a file whose name somebody
// gave: it would be replaced.
void refuse_what_is_no_file(const std::filesystem::path &path);

// Hidden and beside `path`, and another each time, as several processes may write to one directory:
// ".NAME.0123abcd.partial".
std::filesystem::path temporary_name(const std::filesystem::path &path);
// The name without what temporary_name() has added; nothing where that would not have given it.
std::optional<std::string> name_of_temporary(const std::string &temporary);

// Whatever is no directory; nothing is done where there is none. Throws Error (output) as an OutputFile does.
void remove_file(const std::filesystem::path &path);

} // namespace pmdsim
