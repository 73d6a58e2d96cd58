#include "engine/vulkan/commands.h"

#include "engine/vulkan/errors.h"

#include <cstdint>
#include <limits>

namespace pmdsim::vulkan {
namespace {

vk::raii::CommandBuffer allocate(const Device &device, const vk::raii::CommandPool &pool) {
  vk::raii::CommandBuffers buffers(device.get(), {*pool, vk::CommandBufferLevel::ePrimary, 1});
  return std::move(buffers.front());
}

} // namespace

Commands::Commands(const Device &device)
    : device_(&device), pool_(checked([&] {
        return vk::raii::CommandPool(device.get(),
                                     {vk::CommandPoolCreateFlagBits::eTransient, device.queue_family()});
      })),
      buffer_(checked([&] { return allocate(device, pool_); })),
      fence_(checked([&] { return vk::raii::Fence(device.get(), vk::FenceCreateInfo()); })) {}

const vk::raii::CommandBuffer &Commands::begin() {
  checked([&] {
    pool_.reset();
    buffer_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  });
  return buffer_;
}

void Commands::submit_and_wait() {
  checked([&] {
    buffer_.end();
    const vk::CommandBufferSubmitInfo command(*buffer_);
    device_->queue().submit2(vk::SubmitInfo2({}, {}, command), *fence_);
    constexpr auto forever = std::numeric_limits<std::uint64_t>::max();
    if (device_->get().waitForFences(*fence_, true, forever) != vk::Result::eSuccess)
      throw Error(ExitCode::device_lost, "the device did not finish its work");
    device_->get().resetFences(*fence_);
  });
  device_->require_no_validation_message();
}

void memory_barrier(const vk::raii::CommandBuffer &commands, vk::PipelineStageFlags2 after,
                    vk::AccessFlags2 written, vk::PipelineStageFlags2 before, vk::AccessFlags2 used) {
  const vk::MemoryBarrier2 barrier(after, written, before, used);
  commands.pipelineBarrier2(vk::DependencyInfo({}, barrier));
}

void compute_barrier(const vk::raii::CommandBuffer &commands) {
  using Access = vk::AccessFlagBits2;
  constexpr auto compute = vk::PipelineStageFlagBits2::eComputeShader;
  memory_barrier(commands, compute, Access::eShaderStorageWrite,
                 compute | vk::PipelineStageFlagBits2::eDrawIndirect,
                 Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eIndirectCommandRead);
}

} // namespace pmdsim::vulkan
