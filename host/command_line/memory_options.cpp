#include "host/command_line/memory_options.h"

#include "engine/model/error.h"
#include "host/input/file/input_error.h"
#include "host/memory/byte_count.h"

#include <CLI/CLI.hpp>

namespace pmdsim {

void add_max_memory(CLI::App &command, std::optional<std::string> &written) {
  command.add_option("--max-memory", written,
                     "the most that the process may take, e.g. 4GB or \"500 MiB\"; what would need more is "
                     "refused before it is begun, exit code 5 [what the machine, or its control group, has "
                     "left]");
}

std::optional<std::uint64_t> max_memory_of(const std::optional<std::string> &written) {
  if (!written)
    return std::nullopt;
  const auto bytes = byte_count(*written);
  if (!bytes)
    throw Error(ExitCode::usage, "--max-memory: expected a number of bytes with its unit, B, kB, MB, GB, TB, "
                                 "KiB, MiB, GiB or TiB, e.g. 4GB, found " +
                                     in_quotes(*written));
  return bytes;
}

} // namespace pmdsim
