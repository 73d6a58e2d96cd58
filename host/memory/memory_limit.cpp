#include "host/memory/memory_limit.h"

#include "engine/model/error.h"
#include "host/memory/byte_count.h"
#include "host/memory/machine_memory.h"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>

namespace pmdsim {
namespace {

std::atomic<std::uint64_t> max_bytes{0}; // 0: what there is

// What is too little to ask the system about, which takes some 50 us.
constexpr std::uint64_t few_bytes = std::uint64_t{1} << 24;

} // namespace

void set_max_memory(std::optional<std::uint64_t> bytes) { max_bytes = bytes.value_or(0); }

std::uint64_t memory_left() {
  if (const std::uint64_t most = max_bytes; most > 0)
    return most - std::min(most, taken_memory());
  return available_memory().bytes;
}

std::optional<std::string> lack_of_memory(std::uint64_t bytes) {
  const std::uint64_t most = max_bytes;
  if (most == 0) {
    if (bytes < few_bytes)
      return std::nullopt;
    const AvailableMemory available = available_memory();
    if (bytes <= available.bytes)
      return std::nullopt;
    return fmt::format("needs {} more, {} has {} left", byte_text(bytes), available.of,
                       byte_text(available.bytes));
  }
  const std::uint64_t taken = taken_memory();
  if (taken <= most && bytes <= most - taken)
    return std::nullopt;
  return fmt::format("needs {} beside the {} that are taken, --max-memory is {}", byte_text(bytes),
                     byte_text(taken), byte_text(most));
}

void ask_for_memory(std::uint64_t bytes, const std::string &what, const std::string &remedy) {
  if (const auto lack = lack_of_memory(bytes))
    throw Error(ExitCode::out_of_memory, fmt::format("out of memory: {} {}: {}", what, *lack, remedy));
}

} // namespace pmdsim
