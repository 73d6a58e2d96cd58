#include "host/output/files/output_directory.h"

#include "engine/model/error.h"

#include <cerrno>
#include <fmt/format.h>
#include <ranges>
#include <system_error>
#include <unistd.h>

namespace pmdsim {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> missing_directories(const fs::path &directory) {
  std::vector<fs::path> missing;
  std::error_code ignored;
  for (fs::path path = directory; !path.empty() && !fs::exists(path, ignored); path = path.parent_path())
    missing.insert(missing.begin(), path);
  return missing;
}

void remove_if_empty(const std::vector<fs::path> &directories) {
  std::error_code ignored;
  for (const fs::path &path : std::views::reverse(directories))
    fs::remove(path, ignored);
}

// A trailing slash would make parent_path() name the same directory again.
fs::path without_trailing_slash(const fs::path &path) {
  return path.has_filename() || !path.has_relative_path() ? path : path.parent_path();
}

} // namespace

OutputDirectory::OutputDirectory(const fs::path &directory)
    : path_(without_trailing_slash(directory)), created_(missing_directories(path_)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (!error && ::access(path_.c_str(), W_OK | X_OK) != 0)
    error = std::error_code(errno, std::generic_category());
  if (error) {
    remove_if_empty(created_);
    throw Error(ExitCode::output,
                fmt::format("{}: output directory cannot be written: {}", path_.string(), error.message()));
  }
}

void refuse_linked_folders(const fs::path &directory, const fs::path &folder) {
  fs::path path = directory;
  for (const fs::path &part : folder) {
    path /= part;
    std::error_code ignored;
    if (fs::is_symlink(path, ignored))
      throw Error(
          ExitCode::output,
          fmt::format("{}: is a symbolic link, expected a folder or nothing: nothing is written through "
                      "links inside of the output directory",
                      path.string()));
  }
}

OutputDirectory::~OutputDirectory() { remove_if_empty(created_); }

} // namespace pmdsim
