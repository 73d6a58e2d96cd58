#pragma once
// The memory that the program may take. Whoever is about to take much asks first, so that a clear error comes
// instead of the kernel, which ends programs without a word.

#include <cstdint>
#include <optional>
#include <string>

namespace pmdsim {

// What --max-memory says, of all that the process takes. Without, the limit is what the machine, or its
// control group, has left whenever somebody asks.
void set_max_memory(std::optional<std::uint64_t> bytes);

// How much more may be taken now.
std::uint64_t memory_left();

// Why there is no room for so many bytes more: "needs 3.2 GB beside the 210 MB that are taken, --max-memory
// is 2 GB". Nothing where there is.
std::optional<std::string> lack_of_memory(std::uint64_t bytes);

// Throws Error (out_of_memory) where there is no room for so many bytes more. `what` needs them, and `remedy`
// is what can be done: "take fewer pixels".
void ask_for_memory(std::uint64_t bytes, const std::string &what, const std::string &remedy);

} // namespace pmdsim
