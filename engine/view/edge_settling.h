#pragma once
// Puts right what the raster's grid may have decided the wrong way (engine/view/edge_samples.h).

#include "engine/model/simulator_options.h"
#include "engine/sampling/sample_grid.h"
#include "engine/view/edge_samples.h"
#include "engine/vulkan/compute_pipeline.h"

#include <optional>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace pmdsim {

class EdgeSettling {
public:
  // `grid`: given where the samples have records.
  EdgeSettling(const vulkan::Device &device, SamplePrecision precision, const Sensor &sensor,
               const CameraScene &camera, const Scene &scene, const std::vector<RasterBlock> &blocks,
               const std::optional<ChipGrid> &grid);

  // Settles a strip, once the raster has left IDs or records in the buffer; `planes`: TrianglePlane[].
  void record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
              const vulkan::Buffer &planes, const vulkan::Buffer &ids) const;

private:
  EdgeSamples found_;
  vulkan::Buffer samples_;
  std::optional<ChipGrid> grid_;
  std::optional<vulkan::ComputePipeline> settle_; // nothing where no sample lies near an edge
};

} // namespace pmdsim
