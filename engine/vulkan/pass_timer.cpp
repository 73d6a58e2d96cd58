#include "engine/vulkan/pass_timer.h"

#include "engine/vulkan/errors.h"

#include <algorithm>
#include <stdexcept>

namespace pmdsim::vulkan {

PassTimer::PassTimer(const Device &device)
    : ms_per_tick_(device.limits().timestamp_ns * 1e-6), pool_(checked([&] {
        return vk::raii::QueryPool(device.get(),
                                   vk::QueryPoolCreateInfo({}, vk::QueryType::eTimestamp, capacity));
      })) {}

void PassTimer::begin(const vk::raii::CommandBuffer &commands) {
  marks_.clear();
  commands.resetQueryPool(*pool_, 0, capacity);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, 0);
}

void PassTimer::mark(const vk::raii::CommandBuffer &commands, const std::string &name) {
  if (marks_.size() + 1 >= capacity)
    throw std::logic_error("too many passes in one command buffer");
  marks_.push_back(name);
  commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_,
                           static_cast<std::uint32_t>(marks_.size()));
}

void PassTimer::collect() {
  if (marks_.empty())
    return;
  const auto count = static_cast<std::uint32_t>(marks_.size()) + 1;
  const auto ticks = checked([&] {
    return pool_.getResults<std::uint64_t>(0, count, count * sizeof(std::uint64_t), sizeof(std::uint64_t),
                                           vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
  });
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    const double ms = static_cast<double>(ticks.second[i + 1] - ticks.second[i]) * ms_per_tick_;
    const auto known = std::ranges::find(times_, marks_[i], &PassTime::name);
    if (known == times_.end())
      times_.push_back({marks_[i], ms});
    else
      known->ms += ms;
  }
}

} // namespace pmdsim::vulkan
