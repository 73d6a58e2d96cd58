#include "engine/shadow/visibility_bits.h"

#include "engine/vulkan/commands.h"

#include <algorithm>
#include <cstring>
#include <span>

namespace pmdsim {
namespace {

std::size_t words_a_sample(const SourceGroups &groups) { return (groups.diode_count + 31) / 32; }

vk::DeviceSize bytes_of(const SourceWindow &window, const shader::Strip &strip) {
  return vk::DeviceSize{window.bundles} * sample_count(strip) * sizeof(std::uint32_t);
}

// The place of the sample stored at (sy * S + sx) * padded_pixels + p.
std::size_t place_in_frame(const shader::Strip &strip, std::uint32_t subsample, std::uint32_t pixel) {
  const std::size_t column =
      std::size_t{strip.column + pixel % strip.columns} * strip.samples + subsample % strip.samples;
  const std::size_t row =
      std::size_t{strip.row + pixel / strip.columns} * strip.samples + subsample / strip.samples;
  return row * strip.resolution_x * strip.samples + column;
}

// In the strip's own rows of samples.
std::size_t place_in_rows(const shader::Strip &strip, std::uint32_t subsample, std::uint32_t pixel) {
  const std::size_t column = std::size_t{pixel % strip.columns} * strip.samples + subsample % strip.samples;
  const std::size_t row = std::size_t{pixel / strip.columns} * strip.samples + subsample / strip.samples;
  return row * strip.columns * strip.samples + column;
}

void set_bits(std::uint32_t bundle, std::span<const SourcePosition> places, std::uint32_t *sample) {
  for (std::size_t d = 0; d < places.size(); ++d)
    if (const std::uint32_t number = places[d].number; number != no_id)
      sample[number / 32] |= (bundle >> d & 1u) << number % 32;
}

} // namespace

std::vector<std::uint32_t> no_visibility(const Sensor &sensor, const SourceGroups &groups) {
  return std::vector<std::uint32_t>(sensor.pixel_count() * sensor.samples * sensor.samples *
                                    words_a_sample(groups));
}

void full_visibility(const SourceGroups &groups, std::vector<std::uint32_t> &to) {
  const std::size_t words = words_a_sample(groups);
  const std::uint32_t last = groups.diode_count % 32 == 0 ? ~0u : (1u << groups.diode_count % 32) - 1u;
  for (std::size_t i = 0; i < to.size(); ++i)
    to[i] = i % words + 1 == words ? last : ~0u;
}

void record_visibility(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                       const StripBuffers &buffers, const SourceWindow &window) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  vulkan::memory_barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eTransfer,
                         Access::eTransferRead);
  commands.copyBuffer(buffers.visibility.get(), buffers.visibility_read.get(),
                      vk::BufferCopy(0, 0, bytes_of(window, strip)));
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eHost, Access::eHostRead);
}

void store_visibility(const shader::Strip &strip, const StripBuffers &buffers, const SourceWindow &window,
                      const SourceGroups &groups, bool row_by_row, std::vector<std::uint32_t> &to) {
  std::vector<std::uint32_t> bits(bytes_of(window, strip) / sizeof(std::uint32_t));
  std::memcpy(bits.data(), buffers.visibility_read.mapped().data(), bytes_of(window, strip));
  const std::size_t words = words_a_sample(groups), plane = sample_count(strip);
  for (std::uint32_t subsample = 0; subsample < strip.samples * strip.samples; ++subsample)
    for (std::uint32_t pixel = 0; pixel < strip.columns * strip.rows; ++pixel) {
      const std::size_t i = row_by_row ? place_in_rows(strip, subsample, pixel)
                                       : std::size_t{subsample} * strip.padded_pixels + pixel;
      std::uint32_t *const sample = to.data() + place_in_frame(strip, subsample, pixel) * words;
      for (std::uint32_t bundle = 0; bundle < window.bundles; ++bundle)
        set_bits(bits[bundle * plane + i], positions_of(window, bundle, groups), sample);
    }
}

void clear_unseen(Measurement &measurement) {
  const std::size_t words = measurement.sample_visibility.size() / measurement.sample_pixel_id.size();
  for (std::size_t i = 0; i < measurement.sample_pixel_id.size(); ++i)
    if (measurement.sample_pixel_id[i] == 0)
      std::fill_n(measurement.sample_visibility.begin() + static_cast<std::ptrdiff_t>(i * words), words, 0u);
}

} // namespace pmdsim
