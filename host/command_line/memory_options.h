#pragma once
// How much memory a command may take.

#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace pmdsim {

void add_max_memory(CLI::App &command, std::optional<std::string> &written);

// In bytes; nothing where nothing is written. Throws Error (usage).
std::optional<std::uint64_t> max_memory_of(const std::optional<std::string> &written);

} // namespace pmdsim
