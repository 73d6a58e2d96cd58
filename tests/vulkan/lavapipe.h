#pragma once
// What only lavapipe does.

#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::test {

inline bool is_lavapipe(const vk::raii::PhysicalDevice &physical) {
  return physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>()
             .get<vk::PhysicalDeviceDriverProperties>()
             .driverID == vk::DriverId::eMesaLlvmpipe;
}

} // namespace pmdsim::test
