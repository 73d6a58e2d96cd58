#include "engine/passes/pixel_lists.h"

#include "engine/vulkan/commands.h"
#include "spirv/pixel_list_count.h"

#include <algorithm>

namespace pmdsim {
namespace {

vulkan::Buffer make_list(const vulkan::Device &device, std::uint32_t pixels) {
  using Usage = vk::BufferUsageFlagBits;
  return {device, sizeof(shader::PixelList) + vk::DeviceSize{pixels} * sizeof(std::uint32_t),
          Usage::eStorageBuffer | Usage::eIndirectBuffer | Usage::eTransferDst, vulkan::Memory::device};
}

std::uint32_t most_pixels(const std::vector<PlannedStrip> &strips) {
  std::uint32_t most = 0;
  for (const PlannedStrip &planned : strips)
    most = std::max(most, planned.strip.padded_pixels);
  return most;
}

} // namespace

PixelLists::PixelLists(const vulkan::Device &device, const std::vector<PlannedStrip> &strips)
    : lists_{make_list(device, most_pixels(strips)), make_list(device, most_pixels(strips))},
      count_(device, shader::pixel_list_count_spirv, sizeof(shader::PixelListConstants)) {}

void PixelLists::record_clear(const vk::raii::CommandBuffer &commands) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  vulkan::memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect, Access::eShaderStorageWrite,
                         Stage::eTransfer, Access::eTransferWrite);
  const shader::PixelList empty{0, 1, 1, 0, 1, 1, 0, 0};
  for (const vulkan::Buffer &list : lists_)
    commands.updateBuffer<shader::PixelList>(list.get(), 0, empty);
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader,
                         Access::eShaderStorageRead | Access::eShaderStorageWrite);
}

void PixelLists::record_count(const vk::raii::CommandBuffer &commands, std::uint32_t samples) const {
  vulkan::compute_barrier(commands);
  shader::PixelListConstants constants{{}, samples};
  std::ranges::transform(lists_, constants.lists,
                         [](const vulkan::Buffer &list) { return words(list.address()); });
  count_.dispatch(commands, constants, shader::pixel_lists, shader::pixel_lists);
  vulkan::compute_barrier(commands);
}

} // namespace pmdsim
