#pragma once
// One Vulkan device, its one queue (graphics and compute), what the passes must know of its limits, and the
// pipelines that it has compiled.

#include "engine/model/device_info.h"
#include "engine/vulkan/instance.h"
#include "engine/vulkan/shader_module.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

struct Limits {
  vk::DeviceSize storage_bytes = 0;   // of a buffer with the usage eStorageBuffer, at most
  std::uint32_t raster_samples = 0;   // width and height of an attachment, at most
  std::uint32_t viewport_samples = 0; // width and height of a viewport, at most
  double timestamp_ns = 1.0;          // of one tick
  std::uint32_t subgroup = 0;         // invocations of those that are used: 8 to 32
  bool subgroups_sized = false;       // and a pipeline may ask for this size
};

struct Pipeline {
  vk::raii::PipelineLayout layout = nullptr;
  vk::raii::Pipeline pipeline = nullptr;
};

struct PipelineKey {
  const std::uint32_t *spirv; // lives as long as the program
  Specialization constants;
  vk::Format drawn{}; // of graphics pipelines

  auto operator<=>(const PipelineKey &) const = default;
};

// The pipelines that a device has compiled. Drivers take tens to hundreds of milliseconds for a frame's, and
// the next frame asks for the same ones.
class PipelineCache {
public:
  // The pipeline of such a shader; `make` compiles it where it is not known yet.
  std::shared_ptr<const Pipeline> get(const PipelineKey &key, const std::function<Pipeline()> &make);

private:
  std::map<PipelineKey, std::shared_ptr<const Pipeline>> pipelines_;
};

// The usable device that `wanted` names: its index, a part of its name, or "cpu" or "gpu", upper or lower
// case alike; empty: a discrete GPU, else an integrated or virtual one, else whatever there is. Throws Error
// (no_device).
DeviceInfo choose_device(const Instance &instance, const std::string &wanted);

// The empty string where the device can run the simulator, else what it lacks.
std::string what_is_lacking(const vk::raii::PhysicalDevice &device);

class Device {
public:
  Device(const Instance &instance, vk::raii::PhysicalDevice physical);

  const vk::raii::PhysicalDevice &physical() const { return physical_; }
  const vk::raii::Device &get() const { return device_; }
  const vk::raii::Queue &queue() const { return queue_; }
  std::uint32_t queue_family() const { return queue_family_; }
  const Limits &limits() const { return limits_; }
  bool is_cpu() const { return is_cpu_; }
  bool has_fp64() const { return has_fp64_; }
  // This device's pipelines; compiling them does not change the device.
  PipelineCache &pipelines() const { return pipelines_; }
  // Throws std::logic_error with the first of the validation layer's messages, if there is any.
  void require_no_validation_message() const;

  // The first memory type in `allowed` that has all of `wanted`, or failing that all of `needed`.
  std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                            vk::MemoryPropertyFlags needed) const;

  // Whether the host reads such memory as fast as its own.
  bool is_fast_for_the_host(std::uint32_t memory_type) const;

private:
  const Instance *instance_;
  vk::raii::PhysicalDevice physical_;
  vk::PhysicalDeviceMemoryProperties memory_;
  Limits limits_;
  bool is_cpu_;
  bool has_fp64_;
  std::uint32_t queue_family_;
  vk::raii::Device device_;
  vk::raii::Queue queue_;
  mutable PipelineCache pipelines_;
};

} // namespace pmdsim::vulkan
