#pragma once
// The command line, parsed and checked.

#include "host/capture/capture.h"

#include <filesystem>
#include <optional>
#include <string>

namespace pmdsim {

struct Options {
  std::string command;                 // its name: "render"
  CaptureRequest capture;              // all but import-calibration and devices; directories are filled in
  bool mode_written = false;           // bench: one mode instead of all
  std::filesystem::path calibration;   // import-calibration, and the two below
  std::optional<double> pixel_pitch_m; // along the columns, instead of the default
  std::string sensor_name;             // instead of the file's; empty where it is not given
  bool json = false;
};

// Nothing where --help or --version was asked for and has been answered on stdout. Throws Error (usage) in
// one line for what is wrong.
std::optional<Options> parse_options(int argument_count, const char *const *arguments);

} // namespace pmdsim
