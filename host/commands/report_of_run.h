#pragma once
// The report that a run makes of itself when it ends.

#include "host/capture/capture.h"
#include "host/command_line/options.h"

#include <string>

namespace pmdsim {

// Writes the page of a finished run where the options ask for it; its path, empty where they do not or where
// there are no frames, as in a shard of few.
std::string report_of_run(const Options &options, const Capture &capture);

// That path for people, below the files that were written.
std::string report_line(const std::string &report);

} // namespace pmdsim
