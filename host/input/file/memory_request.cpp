#include "host/input/file/memory_request.h"

#include "host/memory/memory_limit.h"

#include <fmt/format.h>

namespace pmdsim {

void require_memory(std::uint64_t bytes, const AnyPlace &place, std::string_view what) {
  const auto lack = lack_of_memory(bytes);
  if (!lack)
    return;
  const Error at = input_error(place, fmt::format("out of memory: {} {}", what, *lack));
  throw Error(ExitCode::out_of_memory, at.what(), at.where());
}

} // namespace pmdsim
