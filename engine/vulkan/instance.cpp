#include "engine/vulkan/instance.h"

#include "engine/vulkan/errors.h"

#include <cstdio>
#include <cstdlib>

namespace pmdsim::vulkan {
namespace {

constexpr const char *validation_layer = "VK_LAYER_KHRONOS_validation";

VkBool32 VKAPI_PTR collect(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                           const VkDebugUtilsMessengerCallbackDataEXT *data, void *messages) {
  static_cast<ValidationMessages *>(messages)->emplace_back(data->pMessage);
  return VK_FALSE;
}

vk::DebugUtilsMessengerCreateInfoEXT messenger_info(ValidationMessages &messages) {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  return {{},
          Severity::eWarning | Severity::eError,
          Type::eValidation | Type::ePerformance | Type::eGeneral,
          collect,
          &messages};
}

vk::raii::Context load() {
  try {
    return vk::raii::Context();
  } catch (const std::exception &error) {
    throw Error(ExitCode::no_device, std::string("no Vulkan loader (libvulkan.so.1): ") + error.what());
  }
}

std::vector<vk::ValidationFeatureEnableEXT> features_of(Validation validation) {
  using Feature = vk::ValidationFeatureEnableEXT;
  if (validation == Validation::calls_and_shaders)
    return {Feature::eSynchronizationValidation, Feature::eGpuAssisted,
            Feature::eGpuAssistedReserveBindingSlot};
  return {Feature::eSynchronizationValidation};
}

// With `validation` under the layer, which speaks in `messages`.
vk::raii::Instance create(const vk::raii::Context &loader, Validation validation,
                          ValidationMessages *messages) {
  const vk::ApplicationInfo application("pmdsim", 1, nullptr, 0, VK_API_VERSION_1_3);
  vk::InstanceCreateInfo info({}, &application);
  const auto enabled = features_of(validation);
  const char *extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  vk::DebugUtilsMessengerCreateInfoEXT messenger;
  const vk::ValidationFeaturesEXT features(enabled, {}, &messenger);
  if (validation != Validation::none) {
    messenger = messenger_info(*messages);
    info.setPEnabledLayerNames(validation_layer).setPEnabledExtensionNames(extension).setPNext(&features);
  }
  return checked([&] {
    try {
      return vk::raii::Instance(loader, info);
    } catch (const vk::LayerNotPresentError &) {
      throw Error(ExitCode::no_device, std::string(validation_layer) + " is not installed");
    }
  });
}

// Drivers stay loaded once one has been: some, as NVIDIA's, crash or can no longer start after they have been
// unloaded and loaded again. An instance holds its drivers, so that a process keeps its first one and never
// lets go of it.
struct Drivers {
  vk::raii::Context loader;
  vk::raii::Instance instance;
};

const Drivers &drivers() {
  static const Drivers *const kept = [] {
    vk::raii::Context loader = load();
    vk::raii::Instance instance = create(loader, Validation::none, nullptr);
    return new Drivers{std::move(loader), std::move(instance)};
  }();
  return *kept;
}

} // namespace

Instance::Instance(Validation validation) : instance_(&drivers().instance) {
  if (validation == Validation::none)
    return;
  validated_.emplace(create(drivers().loader, validation, &messages_));
  messenger_.emplace(*validated_, messenger_info(messages_));
  instance_ = &*validated_;
}

Instance::~Instance() {
  if (messages_.empty())
    return;
  for (const std::string &message : messages_)
    std::fprintf(stderr, "%s\n", message.c_str());
  std::abort();
}

std::vector<vk::raii::PhysicalDevice> Instance::devices() const {
  return checked([&]() -> std::vector<vk::raii::PhysicalDevice> {
    try {
      vk::raii::PhysicalDevices found(*instance_);
      return {std::make_move_iterator(found.begin()), std::make_move_iterator(found.end())};
    } catch (const vk::InitializationFailedError &) {
      return {}; // what the loader says where a driver is listed and none starts
    }
  });
}

} // namespace pmdsim::vulkan
