#pragma once
// The setup of a command, with what the command line says instead of it.

#include "host/input/setup/setup.h"
#include "host/options.h"

namespace pmdsim {

// Its warnings go to stderr. Throws Error (input).
Setup load_for_command(const Options &options);

} // namespace pmdsim
