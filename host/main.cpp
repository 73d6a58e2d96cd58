#include "engine/model/error.h"
#include "host/capture/interruption.h"
#include "host/commands/commands.h"
#include "host/options.h"
#include "host/vector_width.h"

#include <fmt/format.h>
#include <new>

namespace {

int report(pmdsim::ExitCode code, const char *message) {
  fmt::print(stderr, "pmdsim: error: {}\n", message);
  return static_cast<int>(code);
}

} // namespace

int main(int argument_count, char **arguments) {
  using namespace pmdsim;
  try {
    stop_on_signals();
    if (const auto options = parse_options(argument_count, arguments)) {
      settle_vector_width();
      run_command(*options);
    }
    return static_cast<int>(ExitCode::done);
  } catch (const Error &error) {
    return report(error.code(), error.what());
  } catch (const std::bad_alloc &) {
    return report(ExitCode::out_of_memory, "out of memory");
  } catch (const std::exception &error) {
    return report(ExitCode::internal, error.what());
  }
}
