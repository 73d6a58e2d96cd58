#pragma once
// Pixels that the uniform-pixel pass leaves to the passes that go sample by sample, in lists that the device
// fills.

#include "engine/sampling/pass.h"
#include "engine/sampling/strip_memory.h"
#include "engine/vulkan/compute_pipeline.h"
#include "shaders/shared/interface.h"

#include <array>
#include <functional>
#include <span>
#include <vector>

namespace pmdsim {

// Room for the list of `pixels` pixels.
vulkan::Buffer make_pixel_list(const vulkan::Device &device, std::uint32_t pixels);
// Fills the list with some thousand pixels at most, whatever was done with it before; `samples` of each.
void record_fill(const vk::raii::CommandBuffer &commands, const vulkan::Buffer &list,
                 std::span<const std::uint32_t> pixels, std::uint32_t samples);

// Puts the first pixel into the list; nothing where there is none.
std::function<void(const Recording &)> fill_with_one(const vulkan::Buffer *list);

class PixelLists {
public:
  // For as many pixels as the largest of the strips has.
  PixelLists(const vulkan::Device &device, const std::vector<PlannedStrip> &strips);

  // Empties the lists, whatever was done with them before.
  void record_clear(const vk::raii::CommandBuffer &commands) const;
  // Counts the work of the passes that follow.
  void record_count(const vk::raii::CommandBuffer &commands, std::uint32_t samples) const;

  const vulkan::Buffer &of(std::uint32_t list) const { return lists_[list]; }

private:
  std::array<vulkan::Buffer, shader::pixel_lists> lists_;
  vulkan::ComputePipeline count_;
};

// Where a list says how many workgroups there are to do, with an invocation for each of its samples or
// pixels.
inline constexpr vk::DeviceSize of_samples = offsetof(shader::PixelList, sample_groups_x);
inline constexpr vk::DeviceSize of_pixels = offsetof(shader::PixelList, pixel_groups_x);

// Dispatches a pass over a list; without one, over `invocations`.
template <typename Constants>
void dispatch_listed(const vulkan::ComputePipeline &pipeline, const vk::raii::CommandBuffer &commands,
                     const Constants &constants, std::uint32_t invocations, const vulkan::Buffer *list,
                     vk::DeviceSize groups) {
  if (list)
    pipeline.dispatch_indirect(commands, constants, *list, groups);
  else
    pipeline.dispatch(commands, constants, invocations, shader::workgroup_size);
}

inline shader::uvec2 address_of(const vulkan::Buffer *list) {
  return list ? list->words() : shader::uvec2(0);
}

} // namespace pmdsim
