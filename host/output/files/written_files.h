#pragma once
// Files that are whole under their temporary names and wait to be published together.

#include "host/output/files/output_file.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

// What becomes a file.
struct FileToWrite {
  std::string name; // a plain file name
  std::function<void(OutputFile &)> write;
};

// Closed.
using WrittenFiles = std::vector<std::unique_ptr<OutputFile>>;

// Throws Error (output).
std::unique_ptr<OutputFile> write_file(const std::filesystem::path &directory, const FileToWrite &file);

// Several at once, on TBB's threads and the calling one; in the order of `files`. Where one fails, its
// exception comes out, and no file is left.
WrittenFiles write_files(const std::filesystem::path &directory, const std::vector<FileToWrite> &files);

} // namespace pmdsim
