#include "engine/model/error.h"
#include "host/commands/commands.h"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <new>
#include <optional>

namespace pmdsim {
namespace {

const std::map<std::string, void (*)(const Options &)> commands{
    {"render", run_render},   {"deform", run_deform},     {"check", run_check},
    {"bench", run_bench},     {"tradeoff", run_tradeoff}, {"import-calibration", run_import_calibration},
    {"devices", run_devices}, {"noise", run_noise},       {"merge", run_merge}};

constexpr const char *width_variable = "LP_NATIVE_VECTOR_WIDTH"; // bits
constexpr const char *cache_variable = "MESA_SHADER_CACHE_DIR";
constexpr const char *usual_width = "256";

std::optional<std::string> environment(const char *name) {
  const char *value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): no other thread has begun
  return value && *value ? std::optional<std::string>(value) : std::nullopt;
}

void set(const char *name, const std::string &value) {
  constexpr int replace = 1;
  ::setenv(name, value.c_str(), replace); // NOLINT(concurrency-mt-unsafe): likewise
}

long bits(const std::string &width) { return std::strtol(width.c_str(), nullptr, 10); }

// As the XDG base directory specification has it.
std::optional<std::filesystem::path> cache_directory() {
  if (const auto cache = environment("XDG_CACHE_HOME"))
    return *cache;
  if (const auto home = environment("HOME"))
    return std::filesystem::path(*home) / ".cache";
  return std::nullopt;
}

// How wide lavapipe's vectors are: what its environment variables say, made safe before anything asks for
// Vulkan's devices. Mesa's cache of compiled shaders on disk does not know the width, so that a width that
// was asked for gets a cache of its own unless the user has chosen one. More than 256 bits become 256:
// Mesa 22.3 crashes where wider fragments meet an attachment.
void settle_vector_width() {
  auto width = environment(width_variable);
  if (!width)
    return;
  if (bits(*width) > 256) {
    width = usual_width;
    set(width_variable, usual_width);
  }
  const auto cache = cache_directory();
  if (cache && !environment(cache_variable)) {
    const std::filesystem::path of_width = *cache / fmt::format("pmdsim_lavapipe_{}", bits(*width));
    std::error_code ignored;                                // without it nothing is kept, which is no error
    std::filesystem::create_directories(of_width, ignored); // Mesa makes no parents
    set(cache_variable, of_width);
  }
}

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
      settle_vector_width();
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
