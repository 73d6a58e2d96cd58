#include "host/capture/interruption.h"

#include "engine/model/error.h"

#include <atomic>
#include <csignal>

namespace pmdsim {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch nothing else");

void remember(int) { interrupted = true; }

} // namespace

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART; // writes under way go on; the flag is looked at between them
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void throw_if_interrupted() {
  if (interrupted)
    throw Error(ExitCode::interrupted, "interrupted");
}

} // namespace pmdsim
