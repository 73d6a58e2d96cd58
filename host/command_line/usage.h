#pragma once
// What is wrong with a command line, in one line: what was expected, and what may have been meant.

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace pmdsim {

// Throws Error (usage) for what `app` would read as something else than was meant: -output as -o utput.
void refuse_misread(const CLI::App &app, const std::vector<std::string> &arguments);

// Why `app` could not parse the arguments, the program's name not among them.
std::string usage_problem(const CLI::App &app, const CLI::ParseError &error,
                          const std::vector<std::string> &arguments);

} // namespace pmdsim
