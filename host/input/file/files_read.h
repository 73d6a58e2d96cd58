#pragma once
// Which files went into what was loaded, and what they held.

#include <compare>
#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

struct FileRead {
  std::string path; // as the file that names it has it: relative to the folder, if it lies below
  std::size_t bytes = 0;
  std::string hash; // content_hash() of these bytes

  auto operator<=>(const FileRead &) const = default;
};

// As long as it lives it notes what input_file.h reads on this thread. A later one takes over until it dies.
class FilesRead {
public:
  // Paths that begin with `folder` and a slash are noted without both.
  explicit FilesRead(const std::filesystem::path &folder);
  ~FilesRead();
  FilesRead(const FilesRead &) = delete;
  FilesRead &operator=(const FilesRead &) = delete;

  // In the order in which they were first read; the same bytes of the same file once.
  const std::vector<FileRead> &list() const { return files_; }

  // For input_file.h: these bytes of the file have been read.
  static void note(const std::filesystem::path &file, std::string_view bytes);

private:
  std::string folder_; // empty, or with a slash at its end
  std::vector<FileRead> files_;
  std::set<FileRead> known_; // the same
  FilesRead *before_;
};

} // namespace pmdsim
