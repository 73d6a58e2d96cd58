#pragma once
// What every function of the C interface does: exceptions become a status, and what there is to tell of them
// is kept for the thread.

#include "engine/model/error.h"
#include "host/library/pmdsim.h"

#include <cstddef>
#include <string>

namespace pmdsim::library {

// What errors name in place of a file, where text is in none.
inline constexpr const char *setup_text = "the setup", *changes_text = "the changes";

// A status that is no exit code of the program.
struct Refusal {
  pmdsim_status status;
  std::string message;
};

inline Refusal bad_argument(std::string message) { return {PMDSIM_BAD_ARGUMENT, std::move(message)}; }
inline Refusal bad_handle(const char *kind) {
  return {PMDSIM_BAD_HANDLE, std::string("expected a ") + kind + ", found a handle that is none, or no more"};
}

// Text that lives until this thread's next call.
const char *keep_for_thread(std::string text);

// Keeps the exception that is being handled for the thread.
pmdsim_status handled_exception() noexcept;
void clear_error() noexcept;

template <class Call>
pmdsim_status guarded(const Call &call) noexcept {
  clear_error();
  try {
    call();
    return PMDSIM_OK;
  } catch (...) {
    return handled_exception();
  }
}

// Where an argument may not be null.
template <class T>
T &required(T *argument, const char *name) {
  if (!argument)
    throw bad_argument(std::string(name) + ": expected one, found NULL");
  return *argument;
}

// A caller's struct as this version has it: `first_size` is what the first version had. Members that an older
// caller has not are 0; what a newer one has beyond must be 0, as nothing is known of it.
void copy_struct(const void *from, std::size_t first_size, void *to, std::size_t size, const char *name);

template <class Struct>
Struct struct_of(const Struct *from, std::size_t first_size, const char *name) {
  Struct copy{};
  copy_struct(&required(from, name), first_size, &copy, sizeof(copy), name);
  return copy;
}

// To a caller's struct, whose struct_size it has: as much as fits.
void fill_struct(const void *from, std::size_t size, std::size_t first_size, void *to, const char *name);

} // namespace pmdsim::library
