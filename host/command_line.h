#pragma once
// What the command line offers: its commands and options, with their words, before anything is checked.

#include "host/accuracy_options.h"
#include "host/diodes_options.h"
#include "host/options.h"
#include "host/report_options.h"
#include "host/setup_options.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pmdsim {

// The command line before it is checked, and those parts of it that are only taken over.
struct Written {
  Options options;
  WrittenAccuracy accuracy;
  WrittenSetups setups;
  WrittenReporting reporting;
  WrittenDiodes diodes;
  std::optional<std::string> samples, frames, shard, paths, suite_name;
  SuiteOptions suite;
  std::vector<std::string> formats, channels;
};

// The formats of the commands that write frames, where none are asked for.
const std::map<std::string, std::vector<std::string>> &default_formats();

// Parsing `app` fills in `written`, which must outlive it.
void add_commands(CLI::App &app, Written &written);

} // namespace pmdsim
