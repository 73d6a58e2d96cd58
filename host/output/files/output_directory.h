#pragma once
// A directory for outputs, which comes with the first of them.

#include <filesystem>
#include <vector>

namespace pmdsim {

class OutputDirectory {
public:
  // Creates the directory and its parents. Throws Error (output) where that fails or nothing can be written
  // there.
  explicit OutputDirectory(const std::filesystem::path &directory);
  // Removes those directories that the constructor made and that are empty, unless they are to stay.
  ~OutputDirectory();
  OutputDirectory(const OutputDirectory &) = delete;
  OutputDirectory &operator=(const OutputDirectory &) = delete;

  const std::filesystem::path &path() const { return path_; } // without a slash at its end
  void stay() { created_.clear(); }

private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> created_; // outermost first
};

// Throws Error (output) where `folder`, or one on the way to it, is a link; `folder` is relative to
// `directory`, which itself may be one. Nothing is written through links that somebody else may have put
// there.
void refuse_linked_folders(const std::filesystem::path &directory, const std::filesystem::path &folder);

} // namespace pmdsim
