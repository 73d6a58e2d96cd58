#include "engine/vulkan/device.h"

#include "engine/vulkan/errors.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace pmdsim::vulkan {
namespace {

// Constants follow the scene, so a scene in motion asks for other pipelines now and then.
constexpr std::size_t most_pipelines = 64;

constexpr auto queue_work = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;

std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice &device) {
  const auto families = device.getQueueFamilyProperties();
  for (std::uint32_t i = 0; i < families.size(); ++i)
    if ((families[i].queueFlags & queue_work) == queue_work && families[i].timestampValidBits > 0)
      return i;
  return std::nullopt;
}

// The size of the subgroups that are used: 32 where a device has a choice.
struct Subgroups {
  std::uint32_t size;
  bool sized;
};

Subgroups subgroups_of(const vk::raii::PhysicalDevice &device) {
  const auto properties =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceVulkan11Properties,
                            vk::PhysicalDeviceVulkan13Properties>();
  const auto features =
      device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
  const auto &of_13 = properties.get<vk::PhysicalDeviceVulkan13Properties>();
  const bool sized = features.get<vk::PhysicalDeviceVulkan13Features>().subgroupSizeControl &&
                     features.get<vk::PhysicalDeviceVulkan13Features>().computeFullSubgroups &&
                     (of_13.requiredSubgroupSizeStages & vk::ShaderStageFlagBits::eCompute);
  const std::uint32_t usual = properties.get<vk::PhysicalDeviceVulkan11Properties>().subgroupSize;
  return {sized ? std::clamp(std::min(usual, 32u), of_13.minSubgroupSize, of_13.maxSubgroupSize) : usual,
          sized};
}

Limits read_limits(const vk::raii::PhysicalDevice &device) {
  const Subgroups subgroups = subgroups_of(device);
  const vk::PhysicalDeviceLimits limits = device.getProperties().limits;
  return {limits.maxStorageBufferRange,
          std::min({limits.maxFramebufferWidth, limits.maxFramebufferHeight, limits.maxImageDimension2D}),
          std::min(limits.maxViewportDimensions[0], limits.maxViewportDimensions[1]),
          static_cast<double>(limits.timestampPeriod),
          subgroups.size,
          subgroups.sized};
}

// Fragments of 512 bits crash where they meet an attachment (Mesa 22.3 swizzles for vectors of 4 or 8 floats
// only). lavapipe tells the width of its vectors in its name.
bool is_too_wide(const vk::raii::PhysicalDevice &device) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  return properties.deviceType == vk::PhysicalDeviceType::eCpu &&
         std::string(properties.deviceName.data()).find("512 bits") != std::string::npos;
}

vk::raii::Device create(const vk::raii::PhysicalDevice &physical, std::uint32_t family, bool fp64) {
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue({}, family, 1, &priority);
  vk::PhysicalDeviceVulkan13Features vulkan13;
  vulkan13.setDynamicRendering(true).setSynchronization2(true).setMaintenance4(true);
  const bool sized = subgroups_of(physical).sized;
  vulkan13.setSubgroupSizeControl(sized).setComputeFullSubgroups(sized);
  vk::PhysicalDeviceVulkan12Features vulkan12;
  vulkan12.setBufferDeviceAddress(true).setPNext(&vulkan13);
  vk::PhysicalDeviceFeatures2 features(vk::PhysicalDeviceFeatures().setShaderFloat64(fp64), &vulkan12);
  return checked([&] {
    return vk::raii::Device(physical, vk::DeviceCreateInfo({}, queue, {}, {}, nullptr, &features));
  });
}

} // namespace

std::string what_is_lacking(const vk::raii::PhysicalDevice &device) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_3)
    return "Vulkan 1.3";
  const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                         vk::PhysicalDeviceVulkan13Features>();
  if (!chain.get<vk::PhysicalDeviceVulkan12Features>().bufferDeviceAddress)
    return "bufferDeviceAddress";
  if (!chain.get<vk::PhysicalDeviceVulkan13Features>().dynamicRendering)
    return "dynamicRendering";
  if (!chain.get<vk::PhysicalDeviceVulkan13Features>().synchronization2)
    return "synchronization2";
  if (is_too_wide(device))
    return "vectors of at most 256 bits (LP_NATIVE_VECTOR_WIDTH)";
  if (device.getProperties().limits.subPixelPrecisionBits < 8)
    return "a raster of 1/256 pixel (subPixelPrecisionBits of 8)"; // what the projection snaps to
  if (!find_queue_family(device))
    return "a queue with graphics, compute and timestamps";
  return "";
}

std::shared_ptr<const Pipeline> PipelineCache::get(const PipelineKey &key,
                                                   const std::function<Pipeline()> &make) {
  if (const auto known = pipelines_.find(key); known != pipelines_.end())
    return known->second;
  if (pipelines_.size() >= most_pipelines)
    std::erase_if(pipelines_, [](const auto &entry) { return entry.second.use_count() == 1; });
  return pipelines_[key] = std::make_shared<const Pipeline>(make());
}

Device::Device(const Instance &instance, vk::raii::PhysicalDevice physical)
    : instance_(&instance), physical_(std::move(physical)), memory_(physical_.getMemoryProperties()),
      limits_(read_limits(physical_)),
      is_cpu_(physical_.getProperties().deviceType == vk::PhysicalDeviceType::eCpu),
      has_fp64_(physical_.getFeatures().shaderFloat64), queue_family_(find_queue_family(physical_).value()),
      device_(create(physical_, queue_family_, has_fp64_)), queue_(device_, queue_family_, 0) {}

void Device::require_no_validation_message() const {
  if (!instance_->messages().empty())
    throw std::logic_error("Vulkan validation: " + instance_->messages().front());
}

std::uint32_t Device::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                  vk::MemoryPropertyFlags needed) const {
  for (const auto flags : {wanted, needed})
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((allowed >> i & 1u) && (memory_.memoryTypes[i].propertyFlags & flags) == flags)
        return i;
  throw Error(ExitCode::out_of_memory,
              "the device has no memory of the kind that a buffer or an image needs");
}

bool Device::is_fast_for_the_host(std::uint32_t memory_type) const {
  using Flag = vk::MemoryPropertyFlagBits;
  const vk::MemoryPropertyFlags fast =
      Flag::eDeviceLocal | Flag::eHostVisible | Flag::eHostCoherent | Flag::eHostCached;
  return (memory_.memoryTypes[memory_type].propertyFlags & fast) == fast;
}

} // namespace pmdsim::vulkan
