#pragma once
// What `pmdsim new` is to write.

#include "host/start/new_setup.h"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pmdsim {

// As it is written.
struct WrittenNew {
  std::string kind = "room";
  std::filesystem::path folder; // empty: the kind's name
  StartWishes wishes;
  bool force = false;
};

void add_new(CLI::App &command, WrittenNew &written);

// Throws Error (usage).
NewSetup new_setup_of(const WrittenNew &written);

} // namespace pmdsim
