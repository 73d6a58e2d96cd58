#include "engine/vulkan/pass_recorder.h"

#include "engine/vulkan/errors.h"

#include <algorithm>
#include <stdexcept>

namespace pmdsim::vulkan {
namespace {

constexpr auto when_all_is_done = vk::PipelineStageFlagBits2::eAllCommands;

} // namespace

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
