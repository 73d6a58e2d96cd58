#pragma once
// Manual pages and completions, made from the command line's own tables. The build asks the program for them
// (packaging/manual.sh).

#include "host/manual/command_table.h"

#include <string>

namespace pmdsim {

// Manual pages of section 1 for man(7)'s macros, in ASCII: of the program, and of one of its commands.
std::string man_page(const CommandTable &table, const std::string &version);
std::string man_page(const CommandTable &table, const CommandRow &command, const std::string &version);

// For each shell the script that completes commands, options, and values where they are named; files
// elsewhere.
std::string bash_completion(const CommandTable &table);
std::string zsh_completion(const CommandTable &table);
std::string fish_completion(const CommandTable &table);

} // namespace pmdsim
