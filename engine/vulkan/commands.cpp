#include "engine/vulkan/commands.h"

#include "engine/vulkan/errors.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace pmdsim::vulkan {
namespace {

constexpr auto when_all_is_done = vk::PipelineStageFlagBits2::eAllCommands;

} // namespace

Commands::Commands(const Device &device)
    : device_(&device), pool_(checked([&] {
        return vk::raii::CommandPool(device.get(),
                                     {vk::CommandPoolCreateFlagBits::eTransient, device.queue_family()});
      })),
      buffer_(checked([&] {
        return std::move(
            vk::raii::CommandBuffers(device.get(), {*pool_, vk::CommandBufferLevel::ePrimary, 1}).front());
      })),
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

void barrier_before_update(const vk::raii::CommandBuffer &commands) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect | Stage::eTransfer,
                 Access::eShaderStorageWrite, Stage::eTransfer, Access::eTransferWrite);
}

void barrier_after_update(const vk::raii::CommandBuffer &commands) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite,
                 Stage::eComputeShader | Stage::eDrawIndirect,
                 Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eIndirectCommandRead);
}

void host_barrier(const vk::raii::CommandBuffer &commands) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  memory_barrier(commands, Stage::eComputeShader | Stage::eColorAttachmentOutput,
                 Access::eShaderStorageWrite | Access::eColorAttachmentWrite, Stage::eHost,
                 Access::eHostRead);
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

PassRecorder::PassRecorder(const Device &device)
    : device_(&device), commands_(device), pool_(checked([&] {
        return vk::raii::QueryPool(device.get(),
                                   vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, capacity));
      })) {}

void PassRecorder::begin() {
  marks_.clear();
  open();
}

void PassRecorder::open() {
  commands_.begin();
  opened_ = std::chrono::steady_clock::now();
  if (device_->is_cpu())
    return;
  commands().resetQueryPool(*pool_, 0, capacity);
  commands().writeTimestamp2(when_all_is_done, *pool_, 0);
}

void PassRecorder::end_pass(const std::string &name) {
  if (device_->is_cpu()) {
    commands_.submit_and_wait();
    add(name, milliseconds_since(opened_));
    open();
    return;
  }
  if (marks_.size() + 1 >= capacity)
    throw std::logic_error("too many passes in one command buffer");
  marks_.push_back(name);
  commands().writeTimestamp2(when_all_is_done, *pool_, static_cast<std::uint32_t>(marks_.size()));
}

void PassRecorder::finish() {
  commands_.submit_and_wait();
  if (!marks_.empty())
    collect_timestamps();
}

void PassRecorder::collect_timestamps() {
  const auto count = static_cast<std::uint32_t>(marks_.size()) + 1;
  const auto ticks = checked([&] {
    return pool_.getResults<std::uint64_t>(0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                           vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  });
  for (std::size_t i = 0; i < marks_.size(); ++i)
    add(marks_[i],
        static_cast<double>(ticks.second[i + 1] - ticks.second[i]) * device_->limits().timestamp_ns * 1e-6);
}

void PassRecorder::add(const std::string &name, double ms) {
  const auto known = std::ranges::find(times_, name, &PassTime::name);
  if (known == times_.end())
    times_.push_back({name, ms});
  else
    known->ms += ms;
}

} // namespace pmdsim::vulkan
