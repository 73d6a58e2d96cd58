#include "host/report/failure.h"

#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>

namespace pmdsim {
namespace {

bool is_of_threads(const std::exception &error) {
  const auto *const of_system = dynamic_cast<const std::system_error *>(&error);
  constexpr std::string_view of_tbb = "pthread_create has failed";
  return (of_system && of_system->code() == std::errc::resource_unavailable_try_again) ||
         std::string_view(error.what()).starts_with(of_tbb);
}

} // namespace

ExitCode exit_code_of(const std::exception &error) noexcept {
  if (const auto *const ours = dynamic_cast<const Error *>(&error))
    return ours->code();
  if (dynamic_cast<const std::bad_alloc *>(&error) || is_of_threads(error))
    return ExitCode::out_of_memory;
  return dynamic_cast<const std::filesystem::filesystem_error *>(&error) ? ExitCode::output
                                                                         : ExitCode::internal;
}

const char *message_of(const std::exception &error) noexcept {
  return dynamic_cast<const std::bad_alloc *>(&error) ? "out of memory" : error.what();
}

} // namespace pmdsim
