#include "engine/signal/read_back.h"

#include "engine/model/error.h"
#include "engine/model/scene.h"
#include "engine/sampling/raster_blocks.h"
#include "engine/signal/channel_layout.h"
#include "engine/vulkan/commands.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <tbb/parallel_for.h>
#include <variant>

namespace pmdsim {
namespace {

// Where a row of a strip's pixels begins, in the strip and in the frame.
struct Row {
  std::size_t in_strip, in_frame, pixels;
};

Row row_of(const shader::Strip &strip, std::uint32_t row) {
  return {std::size_t{row} * strip.columns, std::size_t{strip.row + row} * strip.resolution_x + strip.column,
          strip.columns};
}

// Where a value goes whose rounding and rest the device has: the former is there already. It wraps at
// `period_m`.
struct Unrounded {
  const float *rounded;
  double *to;
  double period_m;
};

// Where the values of a channel on the device go; nowhere where it only fills a pair.
using Destination = std::variant<std::monostate, float *, std::uint32_t *, Unrounded>;

template <typename T>
void put(T *to, std::size_t at, std::uint32_t word) {
  to[at] = std::bit_cast<T>(word);
}
void put(std::monostate, std::size_t, std::uint32_t) {}
void put(const Unrounded &of, std::size_t at, std::uint32_t word) {
  double value = static_cast<double>(of.rounded[at]) + static_cast<double>(std::bit_cast<float>(word));
  if (value < 0.0)
    value += of.period_m;
  of.to[at] = value >= of.period_m ? 0.0 : value;
}

void store_pair(std::span<const shader::uvec2> pair, const Row &row, const Destination &even,
                const Destination &odd) {
  const shader::uvec2 *const from = pair.data() + row.in_strip;
  const auto store = [&](auto to_even, auto to_odd) {
    for (std::size_t i = 0; i < row.pixels; ++i) {
      put(to_even, row.in_frame + i, from[i].x);
      put(to_odd, row.in_frame + i, from[i].y);
    }
  };
  std::visit(store, even, odd);
}

bool is_read_back(const ChannelRow &row, const ChannelLayout &layout, LightBy light) {
  if (!layout.holds(row))
    return false;
  const bool is_light =
      row.at == ChannelMember(&Return::amplitude) || row.at == ChannelMember(&Return::phase_rad) ||
      row.at == ChannelMember(&Return::distance_m) || row.at == ChannelMember(&Measurement::mean_radiance);
  return !is_light || light == LightBy::read_back;
}

// The destinations of what rounding took.
void add_unrounded(const Modulation &modulation, const ChannelLayout &layout, LightBy light, Measurement &to,
                   std::vector<Destination> &destinations) {
  if (!layout.rests)
    return;
  for (std::uint32_t f = 0; light == LightBy::read_back && f < layout.frequencies; ++f) {
    Return &of = to.returns[f];
    const double ambiguity_m = speed_of_light_m_s / (2.0 * modulation.modulation_hz[f]);
    destinations[layout.rest_channels(f)] =
        Unrounded{of.distance_m.data(), of.unrounded_distance_m.data(), ambiguity_m};
  }
  destinations[layout.rest_channels(0) + 1] =
      Unrounded{to.range_m.data(), to.unrounded_range_m.data(), std::numeric_limits<double>::infinity()};
}

// The destination of each channel on the device.
std::vector<Destination> destinations(const Modulation &modulation, const ChannelLayout &layout,
                                      LightBy light, Measurement &to) {
  std::vector<Destination> result(layout.channels());
  for_each_channel(to, [&](const ChannelIndex &of, auto &values) {
    if (is_read_back(of.row, layout, light))
      result[layout.number(of)] = values.data();
  });
  add_unrounded(modulation, layout, light, to, result);
  return result;
}

// All of DeviceSlot::Area::truth, which is no more than a record tells.
void store_truth(std::span<const shader::uvec4> records, const Row &row, const TruthOfRecords &truth,
                 Measurement &to) {
  static_assert(std::ranges::count(channel_rows, DeviceSlot::Area::truth,
                                   [](const ChannelRow &channel) { return channel.slot.area; }) == 4);
  for (std::size_t i = 0; i < row.pixels; ++i) {
    const shader::uvec4 &record = records[row.in_strip + i];
    const float depth_m =
        truth.has_fp64 ? static_cast<float>(std::bit_cast<double>(std::uint64_t{record.w} << 32 | record.z))
                       : std::bit_cast<float>(record.z);
    const std::size_t at = row.in_frame + i;
    to.coverage[at] = depth_m != 0.0f ? 1.0f : 0.0f;
    to.z_m[at] = depth_m != 0.0f ? depth_m : std::numeric_limits<float>::quiet_NaN();
    to.triangle_id[at] = record.x != 0 ? record.y : no_id;
    const bool is_known = record.x != 0 && record.y < truth.object_of_shape.size();
    to.object_id[at] = is_known ? truth.object_of_shape[record.y] : no_id;
  }
}

// Light has no upper bound. Values that a float is too small for are counted, not searched for, as the
// compiler vectorizes a count.
void check_radiance(const Row &row, const ChannelLayout &layout, LightBy light,
                    const Measurement &measurement) {
  for_each_channel(measurement, [&](const ChannelIndex &of, const auto &values) {
    if (of.row.unit != radiance_unit || !is_read_back(of.row, layout, light))
      return;
    const auto of_row = std::span(values).subspan(row.in_frame, row.pixels);
    if (std::ranges::count_if(of_row, [](auto value) { return std::isinf(value); }) > 0)
      throw too_much_light();
  });
}

// Where `tiled`, IDs lie in tiles (shaders/shared/interface.h).
void store_sample_ids(std::span<const std::byte> from, std::size_t id_bytes, const shader::Strip &strip,
                      bool tiled, Measurement &to) {
  const glm::uvec2 samples = glm::uvec2(strip.columns, strip.rows) * strip.samples;
  const glm::uvec2 pixels(strip.columns, strip.rows);
  for (std::uint32_t row = 0; row < samples.y; ++row)
    for (std::uint32_t column = 0; column < samples.x; ++column) {
      const glm::uvec2 sample(column, row), pixel = sample / strip.samples,
                                            subsample = sample % strip.samples;
      const glm::uvec2 at = tiled ? subsample * pixels + pixel : sample;
      shader::uvec2 id;
      std::memcpy(&id, from.data() + (std::size_t{at.y} * samples.x + at.x) * id_bytes, sizeof(id));
      const glm::uvec2 in_frame = glm::uvec2(strip.column, strip.row) * strip.samples + sample;
      const std::size_t to_at = std::size_t{in_frame.y} * strip.resolution_x * strip.samples + in_frame.x;
      to.sample_pixel_id[to_at] = id.x;
      to.sample_triangle_id[to_at] = id.x != 0 ? id.y : no_id;
    }
}

void record_read_back(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                      const StripBuffers &buffers, const Modulation &modulation, bool leaves_truth) {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  vulkan::memory_barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eTransfer,
                         Access::eTransferRead);
  const vk::DeviceSize channel_bytes = vk::DeviceSize{strip.padded_pixels} * sizeof(float);
  const ChannelLayout layout(modulation);
  const vk::DeviceSize first = channel_bytes * (leaves_truth ? layout.first_channel(0) : 0);
  if (!buffers.channels.is_mapped())
    commands.copyBuffer(buffers.channels.get(), buffers.channels_read.get(),
                        vk::BufferCopy(first, first, channel_bytes * layout.channels() - first));
  if (modulation.keeps_terms)
    commands.copyBuffer(buffers.violations.get(), buffers.violations_read.get(),
                        vk::BufferCopy(0, 0, sizeof(shader::BudgetViolations)));
  if (buffers.ids_read.bytes() > 0) {
    const vk::DeviceSize samples = vk::DeviceSize{strip.columns} * strip.rows * strip.samples * strip.samples;
    commands.copyBuffer(buffers.ids.get(), buffers.ids_read.get(),
                        vk::BufferCopy(0, 0, samples * buffers.id_bytes));
  }
  vulkan::memory_barrier(commands, Stage::eTransfer | Stage::eComputeShader | Stage::eColorAttachmentOutput,
                         Access::eTransferWrite | Access::eShaderStorageWrite | Access::eColorAttachmentWrite,
                         Stage::eHost, Access::eHostRead);
}

void store_strip(const shader::Strip &strip, const StripBuffers &buffers, const Sensor &sensor,
                 const Modulation &modulation, const std::optional<TruthOfRecords> &truth, LightBy light,
                 Measurement &measurement) {
  const ChannelLayout layout(modulation);
  const std::vector<Destination> to = destinations(modulation, layout, light, measurement);
  const auto goes_nowhere = [&](std::uint32_t channel) {
    return std::holds_alternative<std::monostate>(to[channel]);
  };
  tbb::parallel_for(0u, strip.rows, [&](std::uint32_t index) {
    const Row row = row_of(strip, index);
    if (truth)
      store_truth(records_for_host(buffers), row, *truth, measurement);
    for (std::uint32_t channel = truth ? layout.first_channel(0) : 0; channel < to.size(); channel += 2)
      if (!goes_nowhere(channel) || !goes_nowhere(channel + 1))
        store_pair(pair_for_host(buffers, strip, channel), row, to[channel], to[channel + 1]);
    check_radiance(row, layout, light, measurement);
  });
  if (!measurement.sample_pixel_id.empty())
    store_sample_ids(ids_for_host(buffers), buffers.id_bytes, strip, is_tiled(sensor), measurement);
}

} // namespace

Measurement make_measurement(const Sensor &sensor, const Modulation &modulation,
                             const SimulatorOptions &options, Measurement &&memory) {
  Measurement measurement = std::move(memory);
  measurement.resolution = sensor.resolution;
  measurement.has_electrons = false;
  const std::size_t pixels = sensor.pixel_count();
  const ChannelLayout layout(modulation);
  measurement.returns.resize(layout.frequencies);
  for (Return &of_frequency : measurement.returns) {
    of_frequency.taps.resize(options.keep_taps ? sensor.taps : layout.taps);
    if (!layout.bounds)
      of_frequency.error_bound_m.clear();
  }
  for_each_channel(measurement, [&](const ChannelIndex &of, auto &values) {
    if (layout.holds(of.row)) // the host fills or clears all others
      values.resize(pixels);
    else if (of.row.slot.area == DeviceSlot::Area::none || of.row.slot.area == DeviceSlot::Area::mean ||
             of.row.slot.area == DeviceSlot::Area::unwrapped || is_on_demand(of.row) ||
             (of.row.slot.area == DeviceSlot::Area::electrons && (!layout.mean || values.size() != pixels)))
      values.clear();
  });
  for_each_unrounded(measurement, [&](const ChannelIndex &of, auto &, auto &unrounded) {
    if (layout.rests && layout.holds(of.row))
      unrounded.resize(pixels);
    else
      unrounded.clear();
  });
  const bool keeps_ids = options.keep_sample_ids || options.keep_visibility;
  for (auto *ids : {&measurement.sample_triangle_id, &measurement.sample_pixel_id})
    ids->resize(keeps_ids ? pixels * sensor.samples * sensor.samples : 0);
  measurement.sample_visibility.clear();
  return measurement;
}

Pass read_back_pass(const Sensor &sensor, const Modulation &modulation, const StripBuffers &buffers,
                    const std::optional<TruthOfRecords> &truth, LightBy light) {
  return {.name = "read_back",
          .reads = ids | channels,
          .writes = no_resource,
          .record =
              [=, &buffers](const Recording &at) {
                record_read_back(at.commands, at.of_strip(), buffers, modulation, truth.has_value());
              },
          .store =
              [=, &buffers](const Recording &at, Measurement &to) {
                store_strip(at.of_strip(), buffers, sensor, modulation, truth, light, to);
              }};
}

shader::BudgetViolations budget_violations(const StripBuffers &buffers) {
  shader::BudgetViolations violations{};
  std::memcpy(&violations, buffers.violations_read.mapped().data(), sizeof(violations));
  return violations;
}

} // namespace pmdsim
