#include "engine/passes/read_back.h"

#include "engine/error.h"
#include "engine/passes/raster_blocks.h"
#include "engine/scene.h"

#include "engine/vulkan/commands.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

namespace pmdsim {
namespace {

// Where a strip's row begins in a channel of the frame.
template <typename T>
T *row_of(std::vector<T> &channel, const shader::Strip &strip, std::uint32_t row) {
  return channel.data() + std::size_t{strip.row + row} * strip.resolution_x + strip.column;
}

// Copies the strip's rows of a pair of channels to their places in a frame.
template <typename T>
void store_rows(std::span<const shader::uvec2> pair, const shader::Strip &strip, std::vector<T> &even,
                std::vector<T> &odd) {
  for (std::uint32_t row = 0; row < strip.rows; ++row) {
    const auto from = pair.subspan(std::size_t{row} * strip.columns, strip.columns);
    T *const to_even = row_of(even, strip, row), *const to_odd = row_of(odd, strip, row);
    for (std::size_t i = 0; i < from.size(); ++i) {
      to_even[i] = std::bit_cast<T>(from[i].x);
      to_odd[i] = std::bit_cast<T>(from[i].y);
    }
  }
}

// Of the first of a pair alone.
void store_rows(std::span<const shader::uvec2> pair, const shader::Strip &strip, std::vector<float> &even) {
  for (std::uint32_t row = 0; row < strip.rows; ++row) {
    const auto from = pair.subspan(std::size_t{row} * strip.columns, strip.columns);
    std::ranges::transform(from, row_of(even, strip, row),
                           [](const shader::uvec2 &words) { return std::bit_cast<float>(words.x); });
  }
}

// Of a channel that a float may be too small for.
void check_finite(const std::vector<float> &channel, const shader::Strip &strip) {
  for (std::uint32_t row = 0; row < strip.rows; ++row) {
    const std::size_t first = std::size_t{strip.row + row} * strip.resolution_x + strip.column;
    if (std::ranges::any_of(std::span(channel).subspan(first, strip.columns),
                            [](float value) { return std::isinf(value); }))
      throw Error(ExitCode::input, "a pixel receives more light than a float can hold: expected less than "
                                   "3.4e38 W/(m^2 sr), by weaker diodes or farther from the scene");
  }
}

// Where `tiled`, tags lie in tiles (shaders/interface.h).
void store_sample_tags(const std::byte *from, std::size_t tag_bytes, const shader::Strip &strip, bool tiled,
                       Measurement &to) {
  const glm::uvec2 samples = glm::uvec2(strip.columns, strip.rows) * strip.samples;
  const glm::uvec2 pixels(strip.columns, strip.rows);
  for (std::uint32_t row = 0; row < samples.y; ++row)
    for (std::uint32_t column = 0; column < samples.x; ++column) {
      const glm::uvec2 sample(column, row), pixel = sample / strip.samples,
                                            subsample = sample % strip.samples;
      const glm::uvec2 at = tiled ? subsample * pixels + pixel : sample;
      shader::uvec2 tag;
      std::memcpy(&tag, from + (std::size_t{at.y} * samples.x + at.x) * tag_bytes, sizeof(tag));
      const glm::uvec2 in_frame = glm::uvec2(strip.column, strip.row) * strip.samples + sample;
      const std::size_t to_at = std::size_t{in_frame.y} * strip.resolution_x * strip.samples + in_frame.x;
      to.sample_pixel_id[to_at] = tag.x;
      to.sample_triangle_id[to_at] = tag.x != 0 ? tag.y : no_id;
    }
}

} // namespace

Measurement make_measurement(const Sensor &sensor, const Signal &signal, const SimulatorOptions &options,
                             Measurement &&memory) {
  Measurement measurement = std::move(memory);
  measurement.resolution = sensor.resolution;
  const std::size_t pixels = sensor.pixel_count();
  measurement.returns.resize(signal.frequencies());
  for (Return &of_frequency : measurement.returns) {
    for (auto *channel : {&of_frequency.amplitude, &of_frequency.phase_rad, &of_frequency.distance_m})
      channel->resize(pixels);
    of_frequency.taps.resize(signal.keep_taps ? signal.taps : 0);
    for (std::vector<float> &tap : of_frequency.taps)
      tap.resize(pixels);
  }
  for (auto *channel : {&measurement.range_m, &measurement.z_m, &measurement.coverage})
    channel->resize(pixels);
  measurement.triangle_id.resize(pixels);
  measurement.object_id.resize(pixels);
  if (signal.lit)
    measurement.lit.resize(pixels);
  const bool keeps_tags = options.keep_sample_tags || options.keep_reached;
  for (auto *ids : {&measurement.sample_triangle_id, &measurement.sample_pixel_id})
    ids->resize(keeps_tags ? pixels * sensor.samples * sensor.samples : 0);
  measurement.sample_reached.clear();
  return measurement;
}

void record_read_back(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                      const StripBuffers &buffers, const Signal &signal) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  vulkan::memory_barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eTransfer,
                         Access::eTransferRead);
  const vk::DeviceSize channel_bytes =
      vk::DeviceSize{strip.padded_pixels} * signal.channels() * sizeof(float);
  if (!buffers.channels.is_mapped())
    commands.copyBuffer(buffers.channels.get(), buffers.channels_read.get(),
                        vk::BufferCopy(0, 0, channel_bytes));
  if (signal.promised)
    commands.copyBuffer(buffers.broken.get(), buffers.broken_read.get(),
                        vk::BufferCopy(0, 0, sizeof(shader::BrokenPromise)));
  if (buffers.tags_read.bytes() > 0) {
    const vk::DeviceSize samples = vk::DeviceSize{strip.columns} * strip.rows * strip.samples * strip.samples;
    commands.copyBuffer(buffers.tags.get(), buffers.tags_read.get(),
                        vk::BufferCopy(0, 0, samples * buffers.tag_bytes));
  }
  vulkan::memory_barrier(commands, Stage::eTransfer | Stage::eComputeShader,
                         Access::eTransferWrite | Access::eShaderStorageWrite, Stage::eHost,
                         Access::eHostRead);
}

shader::BrokenPromise broken_promise(const StripBuffers &buffers) {
  shader::BrokenPromise broken{};
  std::memcpy(&broken, buffers.broken_read.mapped().data(), sizeof(broken));
  return broken;
}

void store_strip(const shader::Strip &strip, const StripBuffers &buffers, const Sensor &sensor,
                 const Signal &signal, Measurement &measurement) {
  const auto store = [&](std::uint32_t channel, auto &...to) {
    store_rows(pair_for_host(buffers, strip, channel), strip, to...);
  };
  store(shader::channel_range_m, measurement.range_m, measurement.z_m);
  store(shader::channel_triangle_id, measurement.triangle_id, measurement.object_id);
  if (signal.lit)
    store(signal.lit_channel(), measurement.lit);
  for (std::uint32_t f = 0; f < signal.frequencies(); ++f) {
    const std::uint32_t first = signal.first_channel(f);
    Return &to = measurement.returns[f];
    store(first + shader::channel_amplitude, to.amplitude, to.phase_rad);
    store(first + shader::channel_distance_m, to.distance_m, measurement.coverage);
    for (std::uint32_t k = 0; k + 1 < to.taps.size(); k += 2)
      store(first + shader::channel_first_tap + k, to.taps[k], to.taps[k + 1]);
    if (to.taps.size() % 2 == 1)
      store(first + shader::channel_first_tap + signal.taps - 1, to.taps.back());
    check_finite(to.amplitude, strip);
    for (const std::vector<float> &tap : to.taps)
      check_finite(tap, strip);
  }
  if (!measurement.sample_pixel_id.empty())
    store_sample_tags(buffers.tags_read.mapped().data(), buffers.tag_bytes, strip, is_tiled(sensor),
                      measurement);
}

} // namespace pmdsim
