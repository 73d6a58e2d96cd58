#pragma once
// What people do first, and examples of each command, which work in a folder where `pmdsim new room` was run.

#include <span>
#include <string>
#include <string_view>

namespace pmdsim {

struct CommandExample {
  std::string_view command; // "render"
  std::string_view line;    // as it is typed, without quotes and what a shell would change
  std::string_view about;
};

std::span<const CommandExample> command_examples();

// The section of a command's help; empty where it has none.
std::string examples_text(std::string_view command);

// What the program says where nothing is asked of it.
std::string first_steps();

} // namespace pmdsim
