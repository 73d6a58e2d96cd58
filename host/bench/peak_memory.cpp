#include "host/bench/peak_memory.h"

#include <fstream>
#include <limits>
#include <string>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace pmdsim {

void restart_peak_memory() {
#ifdef __GLIBC__
  malloc_trim(0); // else what is free already would count
#endif
  std::ofstream("/proc/self/clear_refs") << "5\n"; // Linux: see proc(5)
}

std::optional<std::int64_t> peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string key; status >> key; status.ignore(std::numeric_limits<std::streamsize>::max(), '\n'))
    if (std::int64_t kib = 0; key == "VmHWM:" && status >> kib)
      return 1024 * kib;
  return std::nullopt;
}

} // namespace pmdsim
