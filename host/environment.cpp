#include "host/environment.h"

#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <mutex>
#include <optional>
#include <string>

namespace pmdsim {
namespace {

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

} // namespace

void settle_environment() {
  static std::once_flag once;
  std::call_once(once, settle_vector_width);
}

} // namespace pmdsim
