#pragma once
// HDF5 files that lie in memory, to be read.

#include "host/hdf5/hdf5.h"

#include <string_view>

namespace pmdsim {

// Opens the file, whose bytes must outlive the handle, in a Hdf5Turn; below 0 where it is none. HDF5's own
// driver of files in memory lets it gather small reads, for which 1.10 trusts addresses of damaged files;
// this one does not, and refuses whatever lies beyond the bytes.
Hdf5Handle opened_in_memory(std::string_view bytes);

} // namespace pmdsim
