#include "engine/shadow/tiles.h"

#include <algorithm>

namespace pmdsim {

std::uint32_t tiles_across(std::uint32_t pixels) {
  return (pixels + shader::tile_side - 1) / shader::tile_side;
}

std::uint32_t tile_count(const shader::Strip &strip) {
  return tiles_across(strip.columns) * tiles_across(strip.rows) * strip.samples * strip.samples;
}

std::uint32_t largest_tile_count(std::span<const PlannedStrip> strips) {
  std::uint32_t most = 0;
  for (const PlannedStrip &planned : strips)
    most = std::max(most, tile_count(planned.strip));
  return most;
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
