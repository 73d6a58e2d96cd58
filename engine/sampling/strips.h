#pragma once
// The frame cut into strips that fit the device's buffers.

#include "engine/model/sensor.h"
#include "engine/sampling/raster_blocks.h"
#include "shaders/shared/interface.h"

#include <vector>

namespace pmdsim {

struct PlannedStrip {
  shader::Strip strip;
  std::uint32_t block; // index into Projection::blocks
};

// Whole rows of the blocks, each strip of at most `max_samples` samples but at least one row of a block.
std::vector<PlannedStrip> plan_strips(const Sensor &sensor, const std::vector<RasterBlock> &blocks,
                                      std::uint32_t max_samples);

// Columns and rows of fragments that are rasterised for a strip of `block`, all tiles together.
glm::uvec2 strip_fragments(const shader::Strip &strip, const RasterBlock &block);

// Invocations for `pixels` pixels: whole workgroups, of which the last is spare: what fills up the last
// workgroup of a list of pixels works on its places.
std::uint32_t padded(std::uint32_t pixels);

} // namespace pmdsim
