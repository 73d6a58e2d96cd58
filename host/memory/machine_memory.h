#pragma once
// What memory the machine, or the control group that the program runs in, has left; and what the program has
// taken.

#include <cstdint>
#include <filesystem>
#include <string>

namespace pmdsim {

struct AvailableMemory {
  std::uint64_t bytes;
  std::string of; // "the machine" or "the control group": which of them leaves less
};

// Linux: MemAvailable of /proc/meminfo, and what memory.max (version 2) or memory.limit_in_bytes (version 1)
// of the program's control group, and of those above it, leave; file pages that nobody uses count as left. As
// much as can be where the system does not tell. `root` stands before /proc and /sys, for tests.
AvailableMemory available_memory(const std::filesystem::path &root = "/");

// In memory now: the process's resident set.
std::uint64_t taken_memory();

} // namespace pmdsim
