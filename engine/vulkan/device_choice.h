#pragma once
// Which of Vulkan's devices to use.

#include "engine/model/device_info.h"
#include "engine/vulkan/device.h"

#include <string>
#include <vector>

namespace pmdsim::vulkan {

DeviceInfo describe(std::uint32_t index, const vk::raii::PhysicalDevice &device);

// The usable device that `wanted` names: its index or a part of its name, upper or lower case alike; empty: a
// discrete GPU, else an integrated or virtual one, else whatever there is. Throws Error (no_device).
std::uint32_t choose_device(const std::vector<DeviceInfo> &devices, const std::string &wanted);

} // namespace pmdsim::vulkan
