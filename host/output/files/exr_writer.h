#pragma once
// One OpenEXR file a frame: scan lines, ZIP, floats as FLOAT and ids as UINT, channels under their own names.

#include "host/output/files/channel.h"
#include "host/output/files/output_file.h"

namespace pmdsim {

// Reads the channels where they lie; memory beyond them is a few scan lines. May be called from several
// threads at once. Throws Error (output).
void write_exr(OutputFile &file, const ChannelSet &channels);

} // namespace pmdsim
