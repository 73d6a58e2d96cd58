#pragma once
// Until the disk has what was written. The operating system keeps writes for half a minute or so, and gives
// new names sooner: where the machine stops meanwhile, files would be empty that records speak of.

#include <filesystem>

namespace pmdsim {

// Returns when the disk has all files that this system has written to the file system of `directory`. One
// call for many files costs about as much as fsync() for one. Throws Error (output) where a write has failed,
// also an earlier one that seemed to succeed. File systems that cannot are believed.
void sync_file_system(const std::filesystem::path &directory);

// The same of the names in the directory alone, and of the file that is open as `descriptor`.
void sync_names(const std::filesystem::path &directory);
void sync_file(int descriptor, const std::filesystem::path &file);

} // namespace pmdsim
