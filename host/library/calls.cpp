#include "host/library/calls.h"

#include "host/input/words/utf8.h"
#include "host/library/handles.h"
#include "host/report/failure.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <new>
#include <span>

namespace pmdsim::library {
namespace {

struct LastError {
  std::string message, file, place;
};

thread_local LastError last_error;
thread_local std::string text_of_thread;

pmdsim_status keep(pmdsim_status status, const char *message, const Whereabouts &where = {}) noexcept {
  try {
    last_error = {in_one_line(message), in_one_line(where.file), in_one_line(where.place)};
  } catch (const std::bad_alloc &) { // the status says enough
    last_error = {};
  }
  return status;
}

pmdsim_status keep(const Error &error) noexcept {
  const std::string_view file = error.where().file;
  const bool is_text = file == setup_text || file == changes_text;
  // The program's options are arguments here.
  const bool names_option =
      error.code() == ExitCode::usage && std::string_view(error.what()).starts_with("--");
  const char *message = error.what() + (names_option ? 2 : 0);
  const auto status = static_cast<pmdsim_status>(error.code());
  return is_text ? keep(status, message, {"", error.where().place}) : keep(status, message, error.where());
}

// What stands at the front of a caller's struct. A struct smaller than the first version's is none.
std::size_t size_of(const void *given, std::size_t first_size, const char *name) {
  std::size_t size = 0;
  std::memcpy(&size, given, sizeof(size));
  constexpr std::size_t largest = 4096; // of any version to come
  if (size < first_size || size > largest)
    throw bad_argument(fmt::format("{}: expected a struct_size of {} to {} bytes, as its sizeof is, found {}",
                                   name, first_size, largest, size));
  return size;
}

} // namespace

std::uintptr_t next_handle() {
  static std::atomic<std::uintptr_t> last{0x10000};
  return last += 16;
}

const char *keep_for_thread(std::string text) {
  text_of_thread = std::move(text);
  return text_of_thread.c_str();
}

void clear_error() noexcept { last_error = {}; }

pmdsim_status handled_exception() noexcept {
  try {
    throw;
  } catch (const Refusal &refusal) {
    return keep(refusal.status, refusal.message.c_str());
  } catch (const Error &error) {
    return keep(error);
  } catch (const std::exception &error) {
    return keep(static_cast<pmdsim_status>(exit_code_of(error)), message_of(error));
  } catch (...) {
    return keep(PMDSIM_INTERNAL, "an exception of an unknown kind");
  }
}

void copy_struct(const void *from, std::size_t first_size, void *to, std::size_t size, const char *name) {
  const std::size_t given = size_of(from, first_size, name);
  const std::span bytes(static_cast<const unsigned char *>(from), given);
  if (given > size && std::ranges::any_of(bytes.subspan(size), [](unsigned char byte) { return byte != 0; }))
    throw bad_argument(
        fmt::format("{}: expected 0 beyond its first {} bytes, which is all that version {} knows", name,
                    size, PMDSIM_VERSION));
  std::memcpy(to, from, std::min(given, size));
  std::memcpy(to, &size, sizeof(size));
}

void fill_struct(const void *from, std::size_t size, std::size_t first_size, void *to, const char *name) {
  const std::size_t given = size_of(to, first_size, name);
  std::memcpy(static_cast<unsigned char *>(to) + sizeof(std::size_t),
              static_cast<const unsigned char *>(from) + sizeof(std::size_t),
              std::min(given, size) - sizeof(std::size_t));
}

} // namespace pmdsim::library

using namespace pmdsim::library;

const char *pmdsim_version(void) { return PMDSIM_VERSION; }
int pmdsim_abi(void) { return PMDSIM_ABI; }

const char *pmdsim_error_message(void) { return last_error.message.c_str(); }
const char *pmdsim_error_file(void) { return last_error.file.c_str(); }
const char *pmdsim_error_place(void) { return last_error.place.c_str(); }
