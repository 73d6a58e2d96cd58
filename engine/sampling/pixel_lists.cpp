#include "engine/sampling/pixel_lists.h"

#include "engine/vulkan/commands.h"

#include <algorithm>

namespace pmdsim {

vulkan::Buffer make_pixel_list(const vulkan::Device &device, std::uint32_t pixels) {
  using Usage = vk::BufferUsageFlagBits;
  return {device, sizeof(shader::PixelList) + vk::DeviceSize{pixels} * sizeof(std::uint32_t),
          Usage::eStorageBuffer | Usage::eIndirectBuffer | Usage::eTransferDst, vulkan::Memory::device};
}

namespace {

vulkan::Buffer make_largest_list(const vulkan::Device &device, const std::vector<PlannedStrip> &strips) {
  const auto pixels = [](const PlannedStrip &planned) { return planned.strip.padded_pixels; };
  return make_pixel_list(device, pixels(std::ranges::max(strips, {}, pixels)));
}

} // namespace

PixelLists::PixelLists(const vulkan::Device &device, const std::vector<PlannedStrip> &strips)
    : lists_{make_largest_list(device, strips), make_largest_list(device, strips),
             make_largest_list(device, strips), make_largest_list(device, strips)},
      count_(device, vulkan::shader_module(device, SamplePrecision::automatic, "pixel_list_count"),
             sizeof(shader::PixelListConstants)) {}

void record_fill(const vk::raii::CommandBuffer &commands, const vulkan::Buffer &list,
                 std::span<const std::uint32_t> pixels, std::uint32_t samples) {
  const auto count = static_cast<std::uint32_t>(pixels.size());
  const std::uint32_t groups = (count + shader::workgroup_size - 1) / shader::workgroup_size;
  vulkan::barrier_before_update(commands);
  const shader::PixelList head{groups * samples, 1, 1, groups, 1, 1, count, 0};
  commands.updateBuffer<shader::PixelList>(list.get(), 0, head);
  if (count > 0)
    commands.updateBuffer<std::uint32_t>(list.get(), sizeof(head), pixels);
  vulkan::barrier_after_update(commands);
}

std::function<void(const Recording &)> fill_with_one(const vulkan::Buffer *list) {
  if (list == nullptr)
    return {};
  return [list](const Recording &at) {
    static constexpr std::array<std::uint32_t, 1> first_pixel{0};
    record_fill(at.commands, *list, first_pixel, at.of_strip().samples * at.of_strip().samples);
  };
}

void PixelLists::record_clear(const vk::raii::CommandBuffer &commands) const {
  vulkan::barrier_before_update(commands);
  const shader::PixelList empty{0, 1, 1, 0, 1, 1, 0, 0};
  for (const vulkan::Buffer &list : lists_)
    commands.updateBuffer<shader::PixelList>(list.get(), 0, empty);
  vulkan::barrier_after_update(commands);
}

void PixelLists::record_count(const vk::raii::CommandBuffer &commands, std::uint32_t samples) const {
  vulkan::compute_barrier(commands);
  shader::PixelListConstants constants{{}, samples};
  std::ranges::transform(lists_, constants.lists, [](const vulkan::Buffer &list) { return list.words(); });
  count_.dispatch(commands, constants, 1, 1);
  vulkan::compute_barrier(commands);
}

} // namespace pmdsim
