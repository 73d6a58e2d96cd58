#include "host/commands/loaded_setup.h"

#include <fmt/format.h>

namespace pmdsim {

Setup load_for_command(const Options &options) {
  Setup setup = load_setup(options.setup);
  for (const std::string &warning : setup.warnings)
    fmt::print(stderr, "pmdsim: warning: {}\n", warning);
  if (options.samples) {
    for (Sensor &sensor : setup.start.sensors)
      sensor.samples = *options.samples;
    for (auto &sensor : setup.as_used["sensors"])
      sensor["samples"] = *options.samples;
  }
  return setup;
}

} // namespace pmdsim
