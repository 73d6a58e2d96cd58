#pragma once
// The most memory that the process has had in use, a device's own apart.

#include <cstdint>
#include <optional>

namespace pmdsim {

// From here on, as far as the system can tell.
void restart_peak_memory();

// Resident; nothing where the system does not tell.
std::optional<std::int64_t> peak_memory_bytes();

} // namespace pmdsim
