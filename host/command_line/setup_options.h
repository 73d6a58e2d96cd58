#pragma once
// The setups that the command line names, and what it changes in them.

#include "host/capture/variants.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace pmdsim {

// As they are written.
struct WrittenSetups {
  std::vector<std::filesystem::path> setups;
  std::vector<std::string> changes; // PATH=VALUE
  std::optional<std::string> poses; // [NAME=]FILE
  std::optional<std::filesystem::path> variants;
  bool allow_outside = false;
};

// Whether a command takes one setup, or several, with variants.
enum class Setups { none_or_one, one, several };

void add_setups(CLI::App &command, WrittenSetups &written, Setups setups);

// {PATH: VALUE, ...}; a value that is no JSON is text. Throws Error (usage).
nlohmann::json changes_of(const std::vector<std::string> &written);
PosesFromFile poses_of(const std::string &written);

} // namespace pmdsim
