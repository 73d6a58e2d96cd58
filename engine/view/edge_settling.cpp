#include "engine/view/edge_settling.h"

#include "engine/sampling/raster_blocks.h"
#include "engine/vulkan/commands.h"
#include "shaders/shared/constants.h"

#include <algorithm>

namespace pmdsim {

EdgeSettling::EdgeSettling(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
                           const CameraScene &camera, const Scene &scene,
                           const std::vector<RasterBlock> &blocks, const std::optional<ChipGrid> &grid)
    : found_(find_edge_samples(camera, scene, sensor, blocks)),
      samples_(vulkan::upload(device, found_.samples)), grid_(grid) {
  if (!found_.samples.empty())
    settle_.emplace(device, vulkan::shader_module(device, precision, "settle_edges"),
                    sizeof(shader::SettleEdgesConstants),
                    vulkan::Specialization{{shader::constant_tiled, is_tiled(sensor)},
                                           {shader::constant_depth_records, grid.has_value()},
                                           {shader::constant_general_chip, grid && !grid->is_nominal()}});
}

void EdgeSettling::record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
                          const vulkan::Buffer &planes, const vulkan::Buffer &ids) const {
  if (!settle_)
    return;
  const shader::Strip &strip = planned.strip;
  const auto begin = found_.samples.begin();
  const auto of_row = [&](std::uint32_t pixel_row) {
    const auto last = begin + found_.end_of_block[planned.block];
    return std::partition_point(
        begin + (planned.block > 0 ? found_.end_of_block[planned.block - 1] : 0), last,
        [&](const shader::EdgeSample &sample) { return sample.row < pixel_row * strip.samples; });
  };
  const auto first = of_row(strip.row), last = of_row(strip.row + strip.rows);
  const auto count = static_cast<std::uint32_t>(last - first);
  const shader::SettleEdgesConstants constants{
      grid_ ? grid_->of(strip) : shader::SampleGrid{},
      grid_ ? grid_->chip() : shader::uvec2(0),
      planes.words(),
      ids.words(),
      samples_.words(static_cast<vk::DeviceSize>(first - begin) * sizeof(shader::EdgeSample)),
      count,
      strip.column,
      strip.row,
      strip.columns,
      strip.rows,
      strip.samples,
      strip.resolution_x,
      0};
  settle_->dispatch(commands, constants, padded(count), shader::workgroup_size);
  vulkan::memory_barrier(commands, vk::PipelineStageFlagBits2::eComputeShader,
                         vk::AccessFlagBits2::eShaderStorageWrite,
                         vk::PipelineStageFlagBits2::eComputeShader | vk::PipelineStageFlagBits2::eTransfer,
                         vk::AccessFlagBits2::eShaderStorageRead | vk::AccessFlagBits2::eTransferRead);
}

} // namespace pmdsim
