#pragma once
// The Vulkan loader, the instance and the devices that it offers.

#include "engine/model/simulator_options.h"

#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

// The validation layer's messages, collected until somebody asks.
using ValidationMessages = std::vector<std::string>;

class Instance {
public:
  // The process's, whose drivers stay loaded; with `validation` under VK_LAYER_KHRONOS_validation. Throws
  // Error: no_device where there is no loader, no driver or (with `validation`) no layer.
  explicit Instance(Validation validation);
  // Ends the process where the validation layer has spoken: nobody could throw what it says while objects are
  // destroyed.
  ~Instance();
  Instance(const Instance &) = delete;
  Instance &operator=(const Instance &) = delete;

  const vk::raii::Instance &get() const { return *instance_; }
  std::vector<vk::raii::PhysicalDevice> devices() const;
  const ValidationMessages &messages() const { return messages_; }

private:
  ValidationMessages messages_;
  const vk::raii::Instance *instance_; // the process's, or the next one
  std::optional<vk::raii::Instance> validated_;
  std::optional<vk::raii::DebugUtilsMessengerEXT> messenger_;
};

} // namespace pmdsim::vulkan
