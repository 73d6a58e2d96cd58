#pragma once
// The devices that Vulkan offers, as a user sees them, and what they took.

#include <cstdint>
#include <string>
#include <vector>

namespace pmdsim {

struct DeviceInfo {
  std::uint32_t index = 0; // as `--device INDEX` takes it
  std::string name;
  std::string kind;   // "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"
  std::string driver; // name and version
  bool usable = false;
  std::string lacks; // what it lacks, when not usable
};

// Every device that Vulkan offers, in Vulkan's order. Empty where there is no Vulkan at all.
std::vector<DeviceInfo> list_devices();

// The time that one pass of a frame took on the device.
struct PassTime {
  std::string name;
  double ms = 0.0;
};

} // namespace pmdsim
