#pragma once
// The accuracy that the command line asks for.

#include "engine/model/accuracy.h"

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace pmdsim {

// The options as they are written, before they are checked.
struct WrittenAccuracy {
  std::optional<std::string> mode, max_error, max_amplitude_error, precision;
  bool strict = false;
};

// --strict alone, for commands that measure nothing.
void add_strict(CLI::App &command, WrittenAccuracy &written);
void add_accuracy(CLI::App &command, WrittenAccuracy &written);

// A bounded error implies mode automatic unless a mode is written. Throws Error (usage), also where mode
// exact is to bound an error, and where the reference, which is exact in double, is to be anything else.
Accuracy accuracy_of(const WrittenAccuracy &written, bool on_reference);

// Text that is a number and nothing else.
std::optional<double> number_of(std::string_view text);

} // namespace pmdsim
