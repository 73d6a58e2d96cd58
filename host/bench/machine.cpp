#include "host/bench/machine.h"

#include "host/bench/native/native_kernel.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <thread>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace pmdsim {
namespace {

// The variables that Vulkan's loader, Mesa and the program read.
constexpr std::size_t always_told = 3; // the first of them, whether or not they are set
constexpr std::array variables{"LP_NATIVE_VECTOR_WIDTH",
                               "LP_NUM_THREADS",
                               "MESA_SHADER_CACHE_DIR",
                               "MESA_SHADER_CACHE_DISABLE",
                               "MESA_GLSL_CACHE_DIR",
                               "MESA_GLSL_CACHE_DISABLE",
                               "XDG_CACHE_HOME",
                               "LP_DEBUG",
                               "LP_PERF",
                               "GALLIVM_DEBUG",
                               "GALLIVM_PERF",
                               "MESA_VK_DEVICE_SELECT",
                               "VK_DRIVER_FILES",
                               "VK_ICD_FILENAMES",
                               "VK_ADD_DRIVER_FILES",
                               "VK_INSTANCE_LAYERS",
                               "VK_LOADER_LAYERS_ENABLE",
                               "PMDSIM_VALIDATE"};

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos)
      return line.substr(line.find(": ") + 2);
  return "unknown";
}

nlohmann::ordered_json environment() {
  nlohmann::ordered_json set = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const char *value =
        std::getenv(variables[i]); // NOLINT(concurrency-mt-unsafe): nothing changes it meanwhile
    if (value || i < always_told)
      set[variables[i]] = value ? nlohmann::ordered_json(value) : nullptr;
  }
  return set;
}

std::string pass_clock(const Camera &camera) {
  if (camera.is_reference())
    return "clock";
  const auto devices = list_devices();
  const auto device = std::ranges::find(devices, camera.device(), &DeviceInfo::name);
  return device != devices.end() && device->kind == "CPU" ? "clock" : "timestamps";
}

std::string compiler() {
#ifdef __clang__
  return __VERSION__; // begins with its name
#else
  return "GCC " __VERSION__;
#endif
}

} // namespace

Machine this_machine(const Camera &camera) {
  return {camera.device(),  camera.driver(),
          processor_name(), std::max(std::thread::hardware_concurrency(), 1u),
          native_threads(), pass_clock(camera),
          compiler(),       PMDSIM_BUILD_TYPE,
          PMDSIM_VERSION,   environment()};
}

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
