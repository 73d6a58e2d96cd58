#pragma once
// The one route for errors: whatever the user, the device or the disk did wrong is thrown as an Error with
// the exit code that the program ends with, and is caught once, in main. Mistakes of our own are
// std::logic_error.

#include <stdexcept>
#include <string>

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

class Error : public std::runtime_error {
public:
  // `message` is one line that names the file, the place in it and what was expected.
  Error(ExitCode code, const std::string &message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

private:
  ExitCode code_;
};

inline Error too_much_light() {
  return {ExitCode::input, "a pixel receives more light than a float can hold: expected less than "
                           "3.4e38 W/(m^2 sr), by weaker diodes or farther from the scene"};
}

} // namespace pmdsim
