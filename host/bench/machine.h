#pragma once
// The circumstances that a time depends on, and the memory that the process takes.

#include "host/capture/camera.h"

#include <optional>
#include <string>

namespace pmdsim {

// Everything that must be known to measure the same again.
struct Machine {
  std::string device, driver;
  std::string processor;       // "unknown" where the system does not tell
  unsigned hardware_threads;   // of the processor
  unsigned threads;            // that a Vulkan device on the CPU and the native kernel use
  std::string passes_by;       // what tells how long a pass took: "timestamps" of the device, or "clock"
  std::string compiler, build; // of the program
  std::string version;
  nlohmann::ordered_json
      environment; // variables that matter: some, null where not set, and others that are set
};

Machine this_machine(const Camera &camera);

// Begins to count the most memory that the process has in use from here on, a device's own apart, as far as
// the system can tell.
void restart_peak_memory();
// The peak of that memory, resident; nothing where the system does not tell.
std::optional<std::int64_t> peak_memory_bytes();

} // namespace pmdsim
