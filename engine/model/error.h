#pragma once
// The one route for errors: whatever the user, the device or the disk did wrong is thrown as an Error with
// the exit code that the program ends with, and is caught once, in main. Mistakes of our own are
// std::logic_error.

#include <stdexcept>
#include <string>
#include <utility>

namespace pmdsim {

enum class ExitCode : int {
  done = 0,
  internal = 1,
  usage = 2,
  input = 3,
  no_device = 4,
  out_of_memory = 5,
  device_lost = 6,
  output = 7,
  accuracy = 8,
  interrupted = 130,
};

// The file that is wrong, and the place in it: a JSON pointer, or "LINE:COLUMN". Empty where there is none.
struct Whereabouts {
  std::string file{}, place{};
};

class Error : public std::runtime_error {
public:
  // `message` is one line that names the file, the place in it and what was expected; `where` tells the first
  // two to programs.
  Error(ExitCode code, const std::string &message, Whereabouts where = {})
      : std::runtime_error(message), code_(code), where_(std::move(where)) {}
  ExitCode code() const { return code_; }
  const Whereabouts &where() const { return where_; }

private:
  ExitCode code_;
  Whereabouts where_;
};

inline Error too_much_light() {
  return {ExitCode::input, "a pixel receives more light than a float can hold: expected less than "
                           "3.4e38 W/(m^2 sr), by weaker diodes or farther from the scene"};
}

} // namespace pmdsim
