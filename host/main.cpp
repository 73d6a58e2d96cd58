#include "engine/model/error.h"
#include "host/commands/commands.h"
#include "host/environment.h"

#include <fmt/format.h>
#include <map>
#include <new>

namespace pmdsim {
namespace {

const std::map<std::string, void (*)(const Options &)> commands{
    {"render", run_render},   {"deform", run_deform},     {"check", run_check},
    {"bench", run_bench},     {"tradeoff", run_tradeoff}, {"import-calibration", run_import_calibration},
    {"devices", run_devices}, {"noise", run_noise},       {"merge", run_merge},
    {"report", run_report},   {"new", run_new},           {"schema", run_schema},
    {"explain", run_explain}, {"correct", run_correct},   {"diodes", run_diodes}};

int report(ExitCode code, const char *message) {
  fmt::print(stderr, "pmdsim: error: {}\n", message);
  return static_cast<int>(code);
}

} // namespace
} // namespace pmdsim

int main(int argument_count, char **arguments) {
  using namespace pmdsim;
  try {
    stop_on_signals();
    if (const auto options = parse_options(argument_count, arguments)) {
      settle_environment();
      commands.at(options->command)(*options);
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
