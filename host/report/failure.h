#pragma once
// Whatever was thrown, as an exit code and a line: by us, by the standard library, or by a library of others.

#include "engine/model/error.h"

#include <exception>

namespace pmdsim {

// Of an Error its own; out_of_memory where there was no memory, or no room for another thread; output where a
// file system failed; else internal, a mistake of ours.
ExitCode exit_code_of(const std::exception &error) noexcept;
// Lives as long as the exception.
const char *message_of(const std::exception &error) noexcept;

} // namespace pmdsim
