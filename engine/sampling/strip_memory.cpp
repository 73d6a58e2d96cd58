#include "engine/sampling/strip_memory.h"

#include <algorithm>
#include <utility>

namespace pmdsim {

namespace {

// `previous` where it has the size, whose pages are there already; a moving scene's frames differ in little
// else.
vulkan::Buffer make_or_take(const vulkan::Device &device, vulkan::Buffer &previous, vk::DeviceSize bytes,
                            vk::BufferUsageFlags usage, vulkan::Memory memory) {
  if (previous.bytes() == bytes)
    return std::move(previous);
  { const vulkan::Buffer freed = std::move(previous); } // its memory first
  return {device, bytes, usage, memory};
}

// The fragments that an image of that size takes in a buffer (engine/vulkan/image.h) on lavapipe, which draws
// four rows at once.
vk::DeviceSize drawn_fragments(glm::uvec2 fragments) {
  return (vk::DeviceSize{fragments.y} + 3) / 4 * 4 * fragments.x;
}

} // namespace

StripBuffers make_strip_buffers(const vulkan::Device &device, const std::vector<PlannedStrip> &strips,
                                const std::vector<RasterBlock> &blocks, const SampleLayout &layout,
                                const SimulatorOptions &options, StripBuffers &&previous) {
  using Usage = vk::BufferUsageFlagBits;
  vk::DeviceSize samples = 0, ids = 0, pixels = 0, fragments = 0;
  for (const auto &[strip, block] : strips) {
    if (blocks[block].distorted)
      fragments = std::max(fragments, drawn_fragments(blocks[block].fragments));
    samples = std::max<vk::DeviceSize>(samples, sample_count(strip));
    ids = std::max({ids, samples, drawn_fragments(strip.samples * glm::uvec2(strip.columns, strip.rows))});
    pixels = std::max<vk::DeviceSize>(pixels, strip.padded_pixels);
  }
  const auto storage = [&](vulkan::Buffer StripBuffers::*buffer, vk::DeviceSize bytes,
                           vk::BufferUsageFlags more = {}) {
    return make_or_take(device, previous.*buffer, bytes, Usage::eStorageBuffer | more,
                        vulkan::Memory::device);
  };
  const auto read = [&](vulkan::Buffer StripBuffers::*buffer, vk::DeviceSize bytes) {
    return make_or_take(device, previous.*buffer, bytes, Usage::eTransferDst, vulkan::Memory::read);
  };
  const vk::DeviceSize channel_bytes = pixels * layout.channels * sizeof(float);
  const vk::DeviceSize id_bytes = ids * layout.id_bytes;
  const vk::DeviceSize lit_bytes = layout.visibility_words > 0 ? samples * sizeof(std::uint32_t) : 0;
  const vk::DeviceSize term_bytes =
      samples * layout.terms * sizeof(float) + pixels * layout.held_errors * sizeof(shader::vec2);
  const vk::DeviceSize violation_bytes = layout.held_errors > 0 ? sizeof(shader::BudgetViolations) : 0;
  const vk::DeviceSize visibility_bytes = lit_bytes * layout.visibility_words;
  using B = StripBuffers;
  B made;
  made.fragments = storage(&B::fragments, fragments * sizeof(shader::uvec2), Usage::eTransferDst);
  made.ids = storage(&B::ids, id_bytes, Usage::eTransferDst | Usage::eTransferSrc);
  made.position = storage(&B::position, samples * layout.position_bytes);
  made.surface = storage(&B::surface, samples * layout.surface_vectors * sizeof(shader::vec4));
  made.backscatter = storage(&B::backscatter, samples * layout.backscatter_bytes);
  made.visibility = storage(&B::visibility, visibility_bytes, Usage::eTransferDst | Usage::eTransferSrc);
  made.lit = storage(&B::lit, lit_bytes, Usage::eTransferDst);
  made.terms = storage(&B::terms, term_bytes);
  made.violations = storage(&B::violations, violation_bytes, Usage::eTransferDst | Usage::eTransferSrc);
  made.run_moments = storage(&B::run_moments, samples * layout.run_moments * sizeof(float));
  made.sum = storage(&B::sum, samples * layout.sum_planes * layout.sum_bytes);
  made.channels = storage(&B::channels, channel_bytes, Usage::eTransferSrc);
  made.channels_read = read(&B::channels_read, made.channels.is_mapped() ? 0 : channel_bytes);
  made.violations_read = read(&B::violations_read, violation_bytes);
  made.ids_read = read(&B::ids_read, layout.host_reads_ids && !made.ids.is_mapped() ? id_bytes : 0);
  made.visibility_read = read(&B::visibility_read, options.keep_visibility ? visibility_bytes : 0);
  made.id_bytes = layout.id_bytes;
  made.terms_of_sample = layout.terms;
  return made;
}

std::span<const shader::uvec2> pair_for_host(const StripBuffers &buffers, const shader::Strip &strip,
                                             std::uint32_t first) {
  const std::span<const std::byte> all =
      buffers.channels.is_mapped() ? buffers.channels.mapped() : buffers.channels_read.mapped();
  const auto *pairs = reinterpret_cast<const shader::uvec2 *>(all.data());
  return {pairs + std::size_t{first / 2} * strip.padded_pixels, strip.padded_pixels};
}

std::span<const std::byte> ids_for_host(const StripBuffers &buffers) {
  return buffers.ids.is_mapped() ? buffers.ids.mapped() : buffers.ids_read.mapped();
}

std::span<const shader::uvec4> records_for_host(const StripBuffers &buffers) {
  const std::span<const std::byte> all = ids_for_host(buffers);
  return {reinterpret_cast<const shader::uvec4 *>(all.data()), all.size() / sizeof(shader::uvec4)};
}

namespace {
constexpr std::uint32_t buffer_bytes = 1u << 27; // of any, at most
}

std::uint32_t samples_of_a_strip(std::uint32_t usual, std::uint32_t sum_planes, std::uint32_t channels,
                                 std::uint32_t samples_per_pixel) {
  constexpr auto plane_bytes = static_cast<std::uint32_t>(sizeof(shader::vec4)), channel_bytes = 4u;
  return std::min({usual, buffer_bytes / (sum_planes * plane_bytes),
                   buffer_bytes / (channels * channel_bytes) * samples_per_pixel});
}

std::uint32_t samples_of_words(std::uint32_t visibility_words) {
  return static_cast<std::uint32_t>(buffer_bytes / sizeof(std::uint32_t) / std::max(visibility_words, 1u));
}

shader::Strip sample_strip(const shader::Strip &strip, bool depth_records) {
  if (!depth_records)
    return strip;
  const std::uint32_t s = strip.samples;
  return {s * strip.column,
          s * strip.row,
          s * strip.columns,
          s * strip.rows,
          s * strip.resolution_x,
          s * strip.resolution_y,
          1,
          sample_count(strip)};
}

} // namespace pmdsim
