#pragma once
// Device time of each pass by timestamps, added up by name over a frame.

#include "engine/pass_time.h"
#include "engine/vulkan/device.h"

#include <cstdint>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim::vulkan {

class PassTimer {
public:
  explicit PassTimer(const Device &device);

  // Forgets all times: a new frame begins.
  void reset() { times_.clear(); }
  // Once in every command buffer, before its first mark.
  void begin(const vk::raii::CommandBuffer &commands);
  // What was recorded since the last mark, or since begin(), is the pass `name`.
  void mark(const vk::raii::CommandBuffer &commands, const std::string &name);
  // After the command buffer is done: adds its passes' times.
  void collect();

  const std::vector<PassTime> &times() const { return times_; }

private:
  static constexpr std::uint32_t capacity = 16;

  double ms_per_tick_;
  vk::raii::QueryPool pool_;
  std::vector<std::string> marks_;
  std::vector<PassTime> times_;
};

} // namespace pmdsim::vulkan
