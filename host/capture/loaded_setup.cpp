#include "host/capture/loaded_setup.h"

#include "host/capture/exposure.h"

#include <fmt/format.h>

namespace pmdsim {

Setup load_for_command(const Options &options) {
  Setup setup = load_setup(options.setup);
  for (const std::string &warning : setup.warnings)
    fmt::print(stderr, "pmdsim: warning: {}\n", warning);
  if (options.accuracy.mode != Mode::exact && exposes_any_tap_by_tap(setup))
    fmt::print(stderr, "pmdsim: warning: frames whose taps are taken one after the other are taken in mode "
                       "exact, and nothing is claimed of their errors\n");
  if (options.samples) {
    for (Sensor &sensor : setup.start.sensors)
      set_samples(sensor, *options.samples);
    for (auto &sensor : setup.as_used["sensors"])
      sensor["samples"] = sample_choice_json(*options.samples);
  }
  return setup;
}

} // namespace pmdsim
