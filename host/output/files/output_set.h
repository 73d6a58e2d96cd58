#pragma once
// Files that get their names in a directory together: all of them, or none.

#include "host/output/files/output_directory.h"
#include "host/output/files/output_file.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

// A file that is to be written.
struct FileToWrite {
  std::string name; // a plain file name
  std::function<void(OutputFile &)> write;
};

// Files that are written and closed.
using WrittenFiles = std::vector<std::unique_ptr<OutputFile>>;

// Writes several at once, on TBB's threads and the calling one; returns them in the order of `files`. Where
// one fails, its exception, Error (output) among others, comes out, and no file is left.
WrittenFiles write_files(const std::filesystem::path &directory, const std::vector<FileToWrite> &files);

class OutputSet {
public:
  // As OutputDirectory, whose new directories stay once the set is published. A set that dies unpublished
  // removes its temporaries.
  explicit OutputSet(const std::filesystem::path &directory) : directory_(directory) {}

  const std::filesystem::path &directory() const { return directory_.path(); }

  // Writes one file by calling `write`; it gets its name only by publish(). `name` is a plain file name.
  void add(const std::string &name, const std::function<void(OutputFile &)> &write);
  // Files of this directory that are written.
  void add(WrittenFiles files);

  // The paths of the files added so far, in order, with the directory in front.
  std::vector<std::string> paths() const;

  // Waits until the disk has the files, and gives them their names. Throws Error (output).
  void publish();
  // The same of files that the disk has: removes the files in the directory that are named `obsolete`, where
  // there are any, and renames all of the set to their names. Throws Error (output): where a directory has
  // one of the names, before anything is replaced; where a rename itself fails, none of the set's files
  // stays.
  void give_names(const std::vector<std::string> &obsolete = {});

private:
  OutputDirectory directory_; // removed, where it is empty, after the files
  WrittenFiles files_;
};

} // namespace pmdsim
