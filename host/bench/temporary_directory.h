#pragma once
// A directory for files that nobody shall find afterwards.

#include "engine/model/error.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <system_error>

namespace pmdsim {

// New, and removed with all that is in it. Throws Error (output) where it cannot be made.
class TemporaryDirectory {
public:
  TemporaryDirectory() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    if (error)
      throw Error(ExitCode::output,
                  fmt::format("TMPDIR: expected a directory for temporary files: {}", error.message()));
    std::string name = (parent / "pmdsim-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw Error(ExitCode::output, fmt::format("{}: temporary directory cannot be made: {}", name,
                                                std::generic_category().message(errno)));
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory &) = delete;
  TemporaryDirectory &operator=(const TemporaryDirectory &) = delete;

  const std::filesystem::path &path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace pmdsim
