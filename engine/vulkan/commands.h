#pragma once
// Recording work, sending it to the queue and waiting for it.

#include "engine/vulkan/device.h"

#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

class Commands {
public:
  explicit Commands(const Device &device);

  // Opens the command buffer, empty.
  const vk::raii::CommandBuffer &begin();
  const vk::raii::CommandBuffer &get() const { return buffer_; }
  // Closes it, submits it and returns when the device is done. Throws Error: device_lost, out_of_memory; and
  // std::logic_error where validation had something to say.
  void submit_and_wait();

private:
  const Device *device_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffer buffer_;
  vk::raii::Fence fence_;
};

// What was written by `after` may be read and written by `before`.
void memory_barrier(const vk::raii::CommandBuffer &commands, vk::PipelineStageFlags2 after,
                    vk::AccessFlags2 written, vk::PipelineStageFlags2 before, vk::AccessFlags2 used);

// Between two compute passes of which the second uses what the first wrote, as data or to know how much to
// do.
void compute_barrier(const vk::raii::CommandBuffer &commands);

} // namespace pmdsim::vulkan
