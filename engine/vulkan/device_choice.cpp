#include "engine/model/error.h"
#include "engine/vulkan/device.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <vector>

namespace pmdsim::vulkan {
namespace {

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string kind_of(vk::PhysicalDeviceType type) {
  // In Vulkan's order.
  constexpr std::array kinds{"other", "integrated GPU", "discrete GPU", "virtual GPU", "CPU"};
  const auto number = static_cast<std::size_t>(type);
  return kinds[number < kinds.size() ? number : 0];
}

int preference(const DeviceInfo &device) {
  const std::array kinds{"discrete GPU", "integrated GPU", "virtual GPU"};
  return static_cast<int>(std::ranges::find(kinds, device.kind) - kinds.begin());
}

std::optional<std::uint32_t> as_index(const std::string &text) {
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(index) : std::nullopt;
}

// By a part of its name, or by what it is: "cpu" or "gpu".
bool is_meant(const DeviceInfo &device, const std::string &wanted) {
  const std::string text = lower_case(wanted);
  const bool is_kind = (text == "cpu" || text == "gpu") && lower_case(device.kind).ends_with(text);
  return is_kind || lower_case(device.name).find(text) != std::string::npos;
}

[[noreturn]] void fail(const std::string &why) {
  throw Error(ExitCode::no_device, "no Vulkan device: " + why);
}

const DeviceInfo &require_usable(const DeviceInfo &device) {
  if (!device.usable)
    fail(device.name + " lacks " + device.lacks);
  return device;
}

DeviceInfo describe(std::uint32_t index, const vk::raii::PhysicalDevice &device) {
  const auto chain =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
  const auto &properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
  const auto &driver = chain.get<vk::PhysicalDeviceDriverProperties>();
  const std::string lacks = what_is_lacking(device);
  return {index,
          properties.deviceName.data(),
          kind_of(properties.deviceType),
          std::string(driver.driverName.data()) + " " + driver.driverInfo.data(),
          lacks.empty(),
          lacks};
}

std::vector<DeviceInfo> devices_of(const Instance &instance) {
  std::vector<DeviceInfo> devices;
  for (const auto &device : instance.devices())
    devices.push_back(describe(static_cast<std::uint32_t>(devices.size()), device));
  return devices;
}

} // namespace

DeviceInfo choose_device(const Instance &instance, const std::string &wanted) {
  const std::vector<DeviceInfo> devices = devices_of(instance);
  if (devices.empty())
    fail("Vulkan offers none; expected a driver for Vulkan 1.3, e.g. Mesa's lavapipe");
  if (const auto index = as_index(wanted)) {
    if (*index >= devices.size())
      fail("--device " + wanted + " is beyond the last index " + std::to_string(devices.size() - 1));
    return require_usable(devices[*index]);
  }
  const DeviceInfo *best = nullptr;
  for (const DeviceInfo &device : devices)
    if (is_meant(device, wanted) && (best == nullptr || std::pair(!device.usable, preference(device)) <
                                                            std::pair(!best->usable, preference(*best))))
      best = &device;
  if (best == nullptr)
    fail("none has '" + wanted + "' in its name, or is one; see `pmdsim devices`");
  return require_usable(*best);
}

} // namespace pmdsim::vulkan

namespace pmdsim {

std::vector<DeviceInfo> list_devices() {
  try {
    return vulkan::devices_of(vulkan::Instance(Validation::none));
  } catch (const Error &error) {
    if (error.code() == ExitCode::no_device)
      return {};
    throw;
  }
}

} // namespace pmdsim
