#pragma once
// The command line, parsed and checked.

#include "host/capture/capture.h"
#include "host/command_line/correct_options.h"
#include "host/command_line/explain_options.h"
#include "host/command_line/new_options.h"
#include "host/output/page/report_page.h"
#include "host/tolerance/diode_study.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// The channel that `deform` makes itself, as --channels names it.
inline constexpr const char *deformation_channel = "deformation_mm";

// bench --suite: procedural scenes.
struct SuiteOptions {
  std::vector<std::string> kinds;    // all but the awkward ones where there are none
  std::uint32_t triangles = 100'000; // of each scene, about
  std::uint32_t columns = 640;       // and rows
  std::filesystem::path directory;   // where the scenes are written instead of timed; empty: nowhere
  std::filesystem::path peer;        // the program to race; empty: none
};

struct Options {
  std::string command; // its name: "render"
  // render: several setups, or variants of them; else there is one, in `capture`.
  std::vector<std::filesystem::path> setups;
  std::optional<std::filesystem::path> variants;
  // All but import-calibration and devices; merge only frames and directory. Directories are filled in.
  CaptureRequest capture;
  bool mode_written = false;                 // bench: one mode instead of all
  std::optional<SuiteOptions> suite;         // bench --suite
  DiodeRequest diodes;                       // diodes
  std::vector<std::filesystem::path> merged; // merge; into capture's output directory, if there is one
  std::optional<ReportRequest> report;       // report; render and deform: --report, then without directory
  std::filesystem::path calibration;         // import-calibration, and the two below
  std::optional<double> pixel_pitch_m;       // along the columns, instead of the default
  std::string sensor_name;                   // instead of the file's; empty where it is not given
  CorrectOptions correct;                    // correct
  std::string calibrated_camera;             // which of the file's cameras; empty: the first
  std::optional<NewSetup> fresh;             // new
  ExplainRequest explain;                    // explain
  std::filesystem::path schema_file;         // schema; empty: stdout
  std::optional<std::uint64_t> max_memory;   // bytes
  bool json = false;
};

// Nothing where nothing but words were asked for, by --help, --version or no argument at all, and they have
// been printed on stdout. Throws Error (usage) in one line for what is wrong.
std::optional<Options> parse_options(int argument_count, const char *const *arguments);

} // namespace pmdsim
