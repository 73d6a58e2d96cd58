// A Vulkan layer: calls of the device fail as tests/faults/plan.h tells, by their names, "vkQueueSubmit2:3"
// say. Every call that the program makes and that returns a VkResult is here. Where a device is lost all that
// the process has are, as when a GPU is reset, until they are made anew. Instances share a driver.

#include "tests/faults/plan.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace pmdsim::faults {
namespace {

const std::array<Plan, 2> plans = plans_of(std::getenv(plan_variable));

std::atomic<bool> has_failed{false};

// What the call returns instead of being made.
std::optional<VkResult> failure_of(const char *called, long number, VkResult usual) {
  for (const Plan &plan : plans)
    if (plan.fails(called, number)) {
      has_failed = true;
      return plan.code != 0 ? static_cast<VkResult>(plan.code) : usual;
    }
  return std::nullopt;
}

// The loader's table for a device, which its queues and command buffers point to as well.
template <class Handle>
const void *device_of(Handle handle) {
  return *reinterpret_cast<const void *const *>(handle);
}

class Devices {
public:
  void add(const void *device) {
    const std::scoped_lock lock(mutex_);
    there_.insert(device);
    lost_.erase(device);
  }
  void remove(const void *device) {
    const std::scoped_lock lock(mutex_);
    there_.erase(device);
  }
  void lose_all() {
    const std::scoped_lock lock(mutex_);
    lost_.insert(there_.begin(), there_.end());
  }
  bool has_lost(const void *device) {
    const std::scoped_lock lock(mutex_);
    return lost_.contains(device);
  }

private:
  std::mutex mutex_;
  std::set<const void *> there_, lost_;
} devices_there;

template <std::size_t N>
struct Name {
  char text[N];
  constexpr Name(const char (&literal)[N]) { std::copy_n(literal, N, text); }
};

// A call whose first argument is a handle of the instance's or the device's, and the driver's own behind it.
template <Name name, VkResult usual, class Function>
struct FailingCall;

template <Name name, VkResult usual, class Handle, class... Arguments>
struct FailingCall<name, usual, VkResult(VKAPI_PTR *)(Handle, Arguments...)> {
  using Function = VkResult(VKAPI_PTR *)(Handle, Arguments...);
  static inline std::atomic<Function> next{nullptr};
  static inline std::atomic<long> calls{0};

  static VkResult VKAPI_CALL call(Handle handle, Arguments... arguments) {
    if (const auto failure = failure_of(name.text, ++calls, usual)) {
      if (*failure == VK_ERROR_DEVICE_LOST)
        devices_there.lose_all();
      return *failure;
    }
    if (usual == VK_ERROR_DEVICE_LOST && devices_there.has_lost(device_of(handle)))
      return VK_ERROR_DEVICE_LOST;
    return next.load()(handle, arguments...);
  }
};

struct Entry {
  const char *name;
  PFN_vkVoidFunction call;
  void (*set_next)(PFN_vkVoidFunction);
  std::atomic<long> *calls;
};

template <Name name, VkResult usual, class Function>
Entry entry() {
  using Call = FailingCall<name, usual, Function>;
  return {name.text, reinterpret_cast<PFN_vkVoidFunction>(Call::call),
          [](PFN_vkVoidFunction next) { Call::next = reinterpret_cast<Function>(next); }, &Call::calls};
}

#define FAILS(NAME, USUAL) entry<#NAME, USUAL, PFN_##NAME>()

std::array device_calls{
    FAILS(vkAllocateCommandBuffers, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkAllocateDescriptorSets, VK_ERROR_OUT_OF_POOL_MEMORY),
    FAILS(vkAllocateMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkBeginCommandBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkBindBufferMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkBindImageMemory, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateBufferView, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateCommandPool, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateComputePipelines, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkCreateDescriptorPool, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateDescriptorSetLayout, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkCreateFence, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkCreateGraphicsPipelines, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkCreateImage, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateImageView, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreatePipelineLayout, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkCreateQueryPool, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkCreateShaderModule, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkEndCommandBuffer, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkFlushMappedMemoryRanges, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkGetQueryPoolResults, VK_ERROR_DEVICE_LOST),
    FAILS(vkInvalidateMappedMemoryRanges, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkMapMemory, VK_ERROR_MEMORY_MAP_FAILED),
    FAILS(vkQueueSubmit2, VK_ERROR_DEVICE_LOST),
    FAILS(vkQueueWaitIdle, VK_ERROR_DEVICE_LOST),
    FAILS(vkDeviceWaitIdle, VK_ERROR_DEVICE_LOST),
    FAILS(vkResetCommandPool, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkResetFences, VK_ERROR_OUT_OF_DEVICE_MEMORY),
    FAILS(vkWaitForFences, VK_ERROR_DEVICE_LOST),
};
std::array instance_calls{
    FAILS(vkEnumeratePhysicalDevices, VK_ERROR_OUT_OF_HOST_MEMORY),
    FAILS(vkGetPhysicalDeviceImageFormatProperties, VK_ERROR_OUT_OF_HOST_MEMORY),
};

std::atomic<long> instances{0}, devices{0};
PFN_vkGetInstanceProcAddr next_of_instance = nullptr;
PFN_vkGetDeviceProcAddr next_of_device = nullptr;
VkInstance instance = VK_NULL_HANDLE;

// The layer's place in the chain that the loader hands on with `create_info`; null where there is none.
template <class Link, class Info>
Link *link_of(const Info *create_info, VkStructureType type) {
  auto *link = const_cast<Link *>(static_cast<const Link *>(create_info->pNext));
  while (link && !(link->sType == type && link->function == VK_LAYER_LINK_INFO))
    link = const_cast<Link *>(static_cast<const Link *>(link->pNext));
  return link;
}

VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *with,
                                    VkInstance *created) {
  if (const auto failure = failure_of("vkCreateInstance", ++instances, VK_ERROR_INITIALIZATION_FAILED))
    return *failure;
  auto *link = link_of<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
  next_of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(next_of_instance(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, with, created);
  if (result == VK_SUCCESS) {
    instance = *created;
    for (const Entry &entry : instance_calls)
      entry.set_next(next_of_instance(instance, entry.name));
  }
  return result;
}

VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                  const VkAllocationCallbacks *with, VkDevice *created) {
  if (const auto failure = failure_of("vkCreateDevice", ++devices, VK_ERROR_INITIALIZATION_FAILED))
    return *failure;
  auto *link = link_of<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
  next_of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(next_of_instance(instance, "vkCreateDevice"));
  const VkResult result = create(physical, info, with, created);
  if (result == VK_SUCCESS) {
    for (const Entry &entry : device_calls)
      entry.set_next(next_of_device(*created, entry.name));
    devices_there.add(device_of(*created));
  }
  return result;
}

void VKAPI_CALL destroy_device(VkDevice device, const VkAllocationCallbacks *with) {
  const auto destroy = reinterpret_cast<PFN_vkDestroyDevice>(next_of_device(device, "vkDestroyDevice"));
  if (device != VK_NULL_HANDLE)
    devices_there.remove(device_of(device));
  destroy(device, with);
}

PFN_vkVoidFunction get_device_call(VkDevice device, const char *name);
PFN_vkVoidFunction get_instance_call(VkInstance of, const char *name);

PFN_vkVoidFunction own_call(std::string_view name) {
  for (const auto &entry : device_calls)
    if (name == entry.name)
      return entry.call;
  for (const auto &entry : instance_calls)
    if (name == entry.name)
      return entry.call;
  if (name == "vkCreateInstance")
    return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
  if (name == "vkCreateDevice")
    return reinterpret_cast<PFN_vkVoidFunction>(create_device);
  if (name == "vkDestroyDevice")
    return reinterpret_cast<PFN_vkVoidFunction>(destroy_device);
  if (name == "vkGetDeviceProcAddr")
    return reinterpret_cast<PFN_vkVoidFunction>(get_device_call);
  return name == "vkGetInstanceProcAddr" ? reinterpret_cast<PFN_vkVoidFunction>(get_instance_call) : nullptr;
}

PFN_vkVoidFunction get_device_call(VkDevice device, const char *name) {
  const auto own = own_call(name);
  return own ? own : next_of_device(device, name);
}

PFN_vkVoidFunction get_instance_call(VkInstance of, const char *name) {
  const auto own = own_call(name);
  return own || !next_of_instance ? own : next_of_instance(of, name);
}

// Appended as tests/faults/failing_calls.cpp does.
struct TellCounts {
  ~TellCounts() {
    const char *name = std::getenv(counts_variable);
    std::FILE *file = name ? std::fopen(name, "a") : nullptr;
    if (!file)
      return;
    std::fprintf(file, "vkCreateInstance %ld\nvkCreateDevice %ld\n", instances.load(), devices.load());
    if (has_failed)
      std::fprintf(file, "failed 1\n");
    for (const auto &entry : device_calls)
      std::fprintf(file, "%s %ld\n", entry.name, entry.calls->load());
    for (const auto &entry : instance_calls)
      std::fprintf(file, "%s %ld\n", entry.name, entry.calls->load());
    std::fclose(file);
  }
} tell_counts;

} // namespace
} // namespace pmdsim::faults

extern "C" __attribute__((visibility("default"))) VkResult
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *interface) {
  interface->loaderLayerInterfaceVersion = 2;
  interface->pfnGetInstanceProcAddr = pmdsim::faults::get_instance_call;
  interface->pfnGetDeviceProcAddr = pmdsim::faults::get_device_call;
  interface->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}
