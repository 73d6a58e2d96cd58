#pragma once
// What the command line offers: its commands and options, with their words, before anything is checked.

#include "host/command_line/accuracy_options.h"
#include "host/command_line/correct_options.h"
#include "host/command_line/diodes_options.h"
#include "host/command_line/memory_options.h"
#include "host/command_line/options.h"
#include "host/command_line/report_options.h"
#include "host/command_line/setup_options.h"
#include "host/manual/command_table.h"

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
  WrittenCorrect correct;
  WrittenDiodes diodes;
  std::optional<std::string> samples, frames, shard, paths, suite_name, max_memory;
  SuiteOptions suite;
  WrittenNew fresh;
  std::vector<std::string> formats, channels;
  std::optional<std::string> output_precision;
};

// The formats of the commands that write frames, where none are asked for.
const std::map<std::string, std::vector<std::string>> &default_formats();

// What completions offer for arguments that take more than a few named values.
void add_suggestions(CommandTable &table);

// Parsing `app` fills in `written`, which must outlive it.
void add_commands(CLI::App &app, Written &written);

} // namespace pmdsim
