#pragma once
// What the command line says about accuracy.

#include "engine/model/accuracy.h"

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace pmdsim {

// As it is written, before it is checked.
struct WrittenAccuracy {
  std::optional<std::string> mode, max_error, max_amplitude_error, precision;
  bool strict = false;
};

void add_accuracy(CLI::App &command, WrittenAccuracy &written);

// An error that is bounded implies mode automatic unless a mode is written. Throws Error (usage): also where
// mode exact shall bound an error, and where the reference, which is exact in double, shall be anything else.
Accuracy accuracy_of(const WrittenAccuracy &written, bool on_reference);

// "0.1mm": a number and m, mm or um, 1e-9 m to 1e6 m; nothing where it is none.
std::optional<double> length_m(std::string_view text);

} // namespace pmdsim
