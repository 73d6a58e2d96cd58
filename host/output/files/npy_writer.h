#pragma once
// NumPy's array file, version 1.0: shape (rows, columns), little-endian, C order, '<f4' or '<u4'; the data
// start at a multiple of 64 bytes, so that they can be mapped. Source: NumPy's documentation,
// numpy.lib.format.

#include "host/output/files/channel.h"
#include "host/output/files/output_file.h"

namespace pmdsim {

// Throws Error (output).
void write_npy(OutputFile &file, const Channel &channel, const glm::uvec2 &resolution);

} // namespace pmdsim
