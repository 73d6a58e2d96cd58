#include "engine/model/error.h"
#include "host/commands/commands.h"
#include "host/environment.h"
#include "host/hdf5/hdf5.h"
#include "host/input/words/utf8.h"
#include "host/memory/memory_limit.h"
#include "host/report/failure.h"
#include "host/report/report.h"
#include "host/threads.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fcntl.h>
#include <new>
#include <string>
#include <string_view>
#include <unistd.h>

namespace pmdsim {
namespace {

struct Command {
  std::string_view name;
  void (*run)(const Options &);
};

constexpr std::array commands{
    Command{"render", run_render},     Command{"deform", run_deform},
    Command{"check", run_check},       Command{"bench", run_bench},
    Command{"tradeoff", run_tradeoff}, Command{"import-calibration", run_import_calibration},
    Command{"devices", run_devices},   Command{"noise", run_noise},
    Command{"merge", run_merge},       Command{"report", run_report},
    Command{"new", run_new},           Command{"schema", run_schema},
    Command{"explain", run_explain},   Command{"correct", run_correct},
    Command{"diodes", run_diodes}};

// So that no file that is opened later takes the number of a stream that is closed, and with it what is
// printed. Writing there fails as before, but for errors and warnings, which nobody wants then.
void keep_streams_apart() noexcept {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

// Needs no memory, as there may be none, and does not mind that nobody listens.
ExitCode report(ExitCode code, const char *message) noexcept {
  if (code == nobody_reads)
    return code;
  std::string line;
  try {
    line = in_one_line(message); // it may quote arguments and names of files
    message = line.c_str();
  } catch (const std::bad_alloc &) {
    line.clear(); // then as it is
  }
  for (const char *text : {"pmdsim: error: ", message, "\n"})
    std::fputs(text, stderr);
  return code;
}

// What was thrown and is being caught, told to the user.
ExitCode report_caught() noexcept {
  try {
    throw;
  } catch (const std::exception &error) {
    return report(exit_code_of(error), message_of(error));
  } catch (...) {
    return report(ExitCode::internal, "an exception of no known kind");
  }
}

// Where memory ends on a path that may throw nothing, such as a destructor. What is half-written then is left
// under its temporary name.
[[noreturn]] void end_at_once() noexcept {
  std::_Exit(static_cast<int>(std::current_exception() ? report_caught()
                                                       : report(ExitCode::internal, "terminated")));
}

// Libraries take memory before main() begins; this comes before them.
[[gnu::section(".preinit_array"), gnu::used]] void (*tell_from_the_start)() = [] {
  std::set_terminate(end_at_once);
};

} // namespace
} // namespace pmdsim

int main(int argument_count, char **arguments) {
  using namespace pmdsim;
  keep_streams_apart();
  try {
    stop_on_signals();
    if (const auto options = parse_options(argument_count, arguments)) {
      settle_environment();
      settle_threads();
      leave_hdf5_open_at_exit();
      set_max_memory(options->max_memory);
      std::ranges::find(commands, options->command, &Command::name)->run(*options);
    }
    print(""); // whose failure tells of what was printed without it, as help is
    return static_cast<int>(ExitCode::done);
  } catch (...) {
    return static_cast<int>(report_caught());
  }
}
