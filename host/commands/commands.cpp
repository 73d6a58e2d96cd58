#include "host/commands/commands.h"

namespace pmdsim {

void run_command(const Options &options) {
  switch (options.command) {
  case Command::render:
    return run_render(options);
  case Command::deform:
    return run_deform(options);
  case Command::check:
    return run_check(options);
  case Command::bench:
    return run_bench(options);
  case Command::tradeoff:
    return run_tradeoff(options);
  case Command::import_calibration:
    return run_import_calibration(options);
  case Command::devices:
    return run_devices(options);
  }
}

} // namespace pmdsim
