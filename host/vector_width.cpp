#include "host/vector_width.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace pmdsim {
namespace {

constexpr const char *width_variable = "LP_NATIVE_VECTOR_WIDTH"; // bits
constexpr const char *cache_variable = "MESA_SHADER_CACHE_DIR";
constexpr const char *usual_width = "256";

std::optional<std::string> environment(const char *name) {
  const char *value = std::getenv(name);
  return value && *value ? std::optional<std::string>(value) : std::nullopt;
}

// As the XDG base directory specification has it.
std::optional<std::filesystem::path> cache_directory() {
  if (const auto cache = environment("XDG_CACHE_HOME"))
    return *cache;
  if (const auto home = environment("HOME"))
    return std::filesystem::path(*home) / ".cache";
  return std::nullopt;
}

} // namespace

void settle_vector_width(bool no_wide_vectors) {
  constexpr int replace = 1;
  auto width = environment(width_variable);
  if (!width)
    return;
  if (no_wide_vectors && std::strtol(width->c_str(), nullptr, 10) > 256) {
    width = usual_width;
    ::setenv(width_variable, usual_width, replace);
  }
  const auto cache = cache_directory();
  if (cache && !environment(cache_variable))
    ::setenv(
        cache_variable,
        (*cache / ("pmdsim_lavapipe_" + std::to_string(std::strtol(width->c_str(), nullptr, 10)))).c_str(),
        replace);
}

} // namespace pmdsim
