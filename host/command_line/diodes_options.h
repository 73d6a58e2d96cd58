#pragma once
// What the command line asks of `diodes`.

#include "host/tolerance/diode_study.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pmdsim {

// As it is written.
struct WrittenDiodes {
  std::optional<std::string> position, axis, intensity, phase, dead, law, boards, seed, pixels;
  std::string sensor;
};

void add_diodes(CLI::App &command, WrittenDiodes &written);

// Throws Error (usage).
DiodeRequest diode_request(const WrittenDiodes &written);

} // namespace pmdsim
