#pragma once
// The command line, parsed and checked.

#include "engine/model/accuracy.h"
#include "host/input/setup/sample_choice.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace pmdsim {

enum class Command { render, deform, check, bench, tradeoff, import_calibration, devices };
enum class Format { exr, npy, png, csv };

// Frames `first` to `end` - 1.
struct FrameRange {
  std::uint32_t first = 0, end = 1;

  std::uint32_t count() const { return end - first; }
};

struct Options {
  Command command = Command::devices;
  std::filesystem::path setup;            // all but import-calibration and devices
  std::filesystem::path output_directory; // render, deform and tradeoff; filled in where -o is absent
  std::set<Format> formats;               // render and deform
  std::optional<FrameRange> frames;       // render and deform, instead of all
  std::string device;                     // as SimulatorOptions::device, or "reference" in any case
  std::optional<SampleChoice> samples;    // instead of the setup's
  Accuracy accuracy;                      // render, deform and bench
  bool mode_written = false;              // bench: one mode instead of all
  std::filesystem::path calibration;      // import-calibration, and the two below
  std::optional<double> pixel_pitch_m;    // along the columns, instead of the default
  std::string sensor_name;                // instead of the file's; empty where it is not given
  bool json = false;
};

// Whether a device's name, in any case, is the one of the reference.
bool names_the_reference(const std::string &device);

// Nothing where --help or --version was asked for and has been answered on stdout. Throws Error (usage) in
// one line for what is wrong.
std::optional<Options> parse_options(int argument_count, const char *const *arguments);

} // namespace pmdsim
