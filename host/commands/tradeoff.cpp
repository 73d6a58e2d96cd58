#include "host/commands/commands.h"
namespace pmdsim {
void run_tradeoff(const Options &) {}
} // namespace pmdsim
