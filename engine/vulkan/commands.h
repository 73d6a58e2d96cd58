#pragma once
// Recording work, sending it to the queue, waiting for it, and the times that passes took.

#include "engine/model/device_info.h"
#include "engine/vulkan/device.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>
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

// Lets the stages `before` read and write what the stages `after` wrote.
void memory_barrier(const vk::raii::CommandBuffer &commands, vk::PipelineStageFlags2 after,
                    vk::AccessFlags2 written, vk::PipelineStageFlags2 before, vk::AccessFlags2 used);

// Between two compute passes of which the second uses what the first wrote, as data or to know how much to
// do.
void compute_barrier(const vk::raii::CommandBuffer &commands);

// Before and after the host's commands write (fill, update) what compute passes work on, as data or to know
// how much to do.
void barrier_before_update(const vk::raii::CommandBuffer &commands);
void barrier_after_update(const vk::raii::CommandBuffer &commands);

// Lets the host read what shaders and rasters wrote, once it knows that they are done.
void host_barrier(const vk::raii::CommandBuffer &commands);

double milliseconds_since(std::chrono::steady_clock::time_point start);

// Records a strip's passes, sends them to the device and adds up what each took.
// On GPUs the passes of one submission are told apart by timestamps. A CPU device (lavapipe) takes its
// timestamps when the rasteriser is flushed, not when compute work ends: there every pass is a submission of
// its own, by the clock.
class PassRecorder {
public:
  explicit PassRecorder(const Device &device);

  // Forgets all times but those given: a new frame begins, or goes on.
  void reset(std::vector<PassTime> times = {}) { times_ = std::move(times); }
  // Opens the command buffer that the passes are recorded to.
  void begin();
  const vk::raii::CommandBuffer &commands() const { return commands_.get(); }
  // Ends the pass `name`: all that was recorded since begin() or the last end_pass().
  void end_pass(const std::string &name);
  // Adds the time of the host's share in the pass `name`.
  void add(const std::string &name, double ms);
  // Returns when the device is done with all passes recorded. Throws as Commands::submit_and_wait().
  void finish();

  // By name, in the order of first appearance, since reset().
  const std::vector<PassTime> &times() const { return times_; }

private:
  static constexpr std::uint32_t capacity = 16;

  void open();
  void collect_timestamps();

  const Device *device_;
  Commands commands_;
  vk::raii::QueryPool pool_;
  std::vector<std::string> marks_; // of the timestamps in the open command buffer
  std::chrono::steady_clock::time_point opened_;
  std::vector<PassTime> times_;
};

} // namespace pmdsim::vulkan
