#include "engine/passes/strip_buffers.h"

#include "shaders/lit_interface.h"

#include <algorithm>
#include <utility>

namespace pmdsim {

StripBuffers make_strip_buffers(const vulkan::Device &device, const std::vector<PlannedStrip> &strips,
                                const std::vector<RasterBlock> &blocks, const Signal &signal,
                                const SampleLayout &layout, const SimulatorOptions &options) {
  using Usage = vk::BufferUsageFlagBits;
  vk::DeviceSize samples = 0, pixels = 0, fragments = 0;
  for (const auto &[strip, block] : strips) {
    if (blocks[block].distorted)
      fragments = std::max(fragments, vk::DeviceSize{blocks[block].fragments.x} * blocks[block].fragments.y);
    samples = std::max<vk::DeviceSize>(samples, sample_count(strip));
    pixels = std::max<vk::DeviceSize>(pixels, strip.padded_pixels);
  }
  const auto storage = [&](vk::DeviceSize bytes, vk::BufferUsageFlags more = {}) {
    return vulkan::Buffer(device, bytes, Usage::eStorageBuffer | more, vulkan::Memory::device);
  };
  const auto read = [&](vk::DeviceSize bytes) {
    return vulkan::Buffer(device, bytes, Usage::eTransferDst, vulkan::Memory::read);
  };
  const vk::DeviceSize channel_bytes = pixels * signal.channels() * sizeof(float);
  const vk::DeviceSize tag_bytes = samples * layout.tag_bytes;
  const vk::DeviceSize lit_bytes = signal.lit ? samples * sizeof(std::uint32_t) : 0;
  const vk::DeviceSize broken_bytes = signal.promised ? sizeof(shader::BrokenPromise) : 0;
  const vk::DeviceSize reached_bytes = lit_bytes * shader::bundles_per_window;
  vulkan::Buffer channels = storage(channel_bytes, Usage::eTransferSrc);
  vulkan::Buffer channels_read = read(channels.is_mapped() ? 0 : channel_bytes);
  return {storage(fragments * sizeof(shader::uvec2), Usage::eTransferDst),
          storage(tag_bytes, Usage::eTransferDst | Usage::eTransferSrc),
          storage(samples * layout.position_bytes),
          storage(samples * layout.surface_vectors * sizeof(shader::vec4)),
          storage(samples * layout.backscatter_bytes),
          storage(reached_bytes, Usage::eTransferDst | Usage::eTransferSrc),
          storage(lit_bytes),
          storage(signal.promised ? samples * sizeof(float) : 0),
          storage(broken_bytes, Usage::eTransferDst | Usage::eTransferSrc),
          storage(samples * signal.sum_planes() * layout.sum_bytes),
          std::move(channels),
          std::move(channels_read),
          read(broken_bytes),
          read(options.keep_sample_tags || options.keep_reached ? tag_bytes : 0),
          read(options.keep_reached ? reached_bytes : 0),
          layout.tag_bytes};
}

std::span<const shader::uvec2> pair_for_host(const StripBuffers &buffers, const shader::Strip &strip,
                                             std::uint32_t first) {
  const std::span<const std::byte> all =
      buffers.channels.is_mapped() ? buffers.channels.mapped() : buffers.channels_read.mapped();
  const auto *pairs = reinterpret_cast<const shader::uvec2 *>(all.data());
  return {pairs + std::size_t{first / 2} * strip.padded_pixels, strip.padded_pixels};
}

std::uint32_t samples_of_a_strip(const Signal &signal, std::uint32_t samples_per_pixel) {
  constexpr std::uint32_t usual = 1u << 20, buffer_bytes = 1u << 27;
  constexpr auto plane_bytes = static_cast<std::uint32_t>(sizeof(shader::vec4)), channel_bytes = 4u;
  return std::min({usual, buffer_bytes / (signal.sum_planes() * plane_bytes),
                   buffer_bytes / (signal.channels() * channel_bytes) * samples_per_pixel});
}

} // namespace pmdsim
