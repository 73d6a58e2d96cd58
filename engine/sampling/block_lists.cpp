#include "engine/sampling/block_lists.h"

#include "engine/vulkan/commands.h"

#include <algorithm>

namespace pmdsim {
namespace {

// In a row of the strip's samples.
std::uint32_t blocks_across(const shader::Strip &strip) {
  return (strip.columns * strip.samples + shader::block_samples - 1) / shader::block_samples;
}

std::uint32_t block_count(const shader::Strip &strip) {
  return blocks_across(strip) * strip.rows * strip.samples;
}

vulkan::Buffer make_block_list(const vulkan::Device &device, std::uint32_t blocks) {
  using Usage = vk::BufferUsageFlagBits;
  return {device, sizeof(shader::WorkList) + vk::DeviceSize{blocks} * sizeof(std::uint32_t),
          Usage::eStorageBuffer | Usage::eIndirectBuffer | Usage::eTransferDst, vulkan::Memory::device};
}

vulkan::Buffer make_largest_block_list(const vulkan::Device &device, std::span<const PlannedStrip> strips) {
  std::uint32_t most = 0;
  for (const PlannedStrip &planned : strips)
    most = std::max(most, block_count(planned.strip));
  return make_block_list(device, most);
}

} // namespace

BlockLists::BlockLists(const vulkan::Device &device, const StripBuffers &buffers,
                       std::span<const PlannedStrip> strips, std::uint32_t shining, bool lists_empty)
    : buffers_(buffers), shining_(shining),
      lists_empty_(lists_empty), lists_{make_largest_block_list(device, strips),
                                        make_largest_block_list(device, strips),
                                        make_largest_block_list(device, strips)},
      sort_(device, vulkan::shader_module(device, SamplePrecision::automatic, "block_lists"),
            sizeof(shader::BlockListConstants)) {}

std::size_t BlockLists::index_of(std::uint32_t kind) const {
  return (kind == shader::blocks_empty && !lists_empty_ ? shader::blocks_lit : kind) - shader::blocks_lit;
}

void BlockLists::record(const Recording &at) const {
  const shader::Strip &strip = at.of_strip();
  vulkan::barrier_before_update(at.commands);
  for (const vulkan::Buffer &list : lists_)
    at.commands.updateBuffer<shader::WorkList>(list.get(), 0, shader::WorkList{1, 0, 1, 0});
  vulkan::barrier_after_update(at.commands);
  shader::BlockListConstants constants{
      buffers_.ids.words(),       buffers_.lit.words(), {},      strip.columns * strip.samples,
      strip.rows * strip.samples, blocks_across(strip), shining_};
  for (std::uint32_t kind = shader::blocks_lit; kind <= shader::block_lists; ++kind)
    constants.lists[kind - shader::blocks_lit] = lists_[index_of(kind)].words();
  sort_.dispatch(at.commands, constants, padded(block_count(strip)), shader::workgroup_size);
}

void BlockLists::write(const shader::Strip &strip, std::span<const std::uint8_t> kinds) const {
  std::array<std::uint32_t, shader::block_lists> counts{};
  std::array<std::uint32_t *, shader::block_lists> entries{};
  for (std::size_t list = 0; list < entries.size(); ++list)
    entries[list] =
        lists_[list].mapped_as<std::uint32_t>() + sizeof(shader::WorkList) / sizeof(std::uint32_t);
  const std::uint32_t columns = strip.columns * strip.samples, across = blocks_across(strip);
  for (std::uint32_t row = 0; row < strip.rows * strip.samples; ++row)
    for (std::uint32_t block = 0; block < across; ++block) {
      const std::size_t list = index_of(kinds[std::size_t{row} * across + block]);
      const std::uint32_t first = block * shader::block_samples;
      entries[list][counts[list]++] = (row * columns + first) * shader::block_samples +
                                      std::min(shader::block_samples, columns - first) - 1;
    }
  constexpr std::uint32_t of_group = shader::workgroup_size / shader::block_samples;
  for (std::size_t list = 0; list < entries.size(); ++list) {
    const std::uint32_t groups = (counts[list] + of_group - 1) / of_group;
    const shader::WorkList head{1, std::min(groups, shader::workgroups_per_row),
                                (groups + shader::workgroups_per_row - 1) / shader::workgroups_per_row,
                                counts[list]};
    *lists_[list].mapped_as<shader::WorkList>() = head;
  }
}

std::function<void(const Recording &)> fill_with_one(const SampleBlocks &blocks) {
  return [blocks](const Recording &at) {
    vulkan::barrier_before_update(at.commands);
    at.commands.updateBuffer<std::uint32_t>(blocks.list->get(), 0,
                                            std::array<std::uint32_t, 5>{1, 1, 1, 1, 0});
    vulkan::barrier_after_update(at.commands);
  };
}

} // namespace pmdsim
