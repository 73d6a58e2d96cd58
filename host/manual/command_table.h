#pragma once
// The command line as plain data, read off the parser's own tables: what manual pages and completions are
// made of, so that neither can tell anything that the program does not take.

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pmdsim {

// An option, or an operand such as SETUP.
struct ArgumentRow {
  std::vector<std::string> names;         // "-o", "--output"; of an operand its name alone: "SETUP"
  std::string value;                      // the kind of its value: "text", "number"; empty for flags
  std::vector<std::string> choices;       // all values that it takes, where they are named
  std::vector<std::string> suggestions{}; // some of them, for completions, where `choices` is empty
  bool is_list = false;                   // takes several values, separated by commas
  bool is_repeated = false;               // an operand of which there may be several
  bool is_required = false;
  std::string about;
};

struct CommandRow {
  std::string name;  // "render"
  std::string about; // as --help says it
  std::vector<ArgumentRow> operands;
  std::vector<ArgumentRow> options;
  std::string footer; // what --help prints below the options; empty where there is nothing
};

struct CommandTable {
  std::string program; // "pmdsim"
  std::string about;
  std::vector<ArgumentRow> options; // without a command
  std::vector<CommandRow> commands;
};

// What completions offer for the argument.
inline const std::vector<std::string> &offered(const ArgumentRow &row) {
  return row.choices.empty() ? row.suggestions : row.choices;
}

// Without what --help hides.
CommandTable table_of(const CLI::App &app);

// Sets the suggestions of the arguments of that name, "--device" or "KEY", of all commands.
void suggest(CommandTable &table, const std::string &argument, const std::vector<std::string> &values);

// Null where there is none of that name.
const CommandRow *find_command(const CommandTable &table, const std::string &name);

} // namespace pmdsim
