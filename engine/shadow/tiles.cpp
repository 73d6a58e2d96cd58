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

} // namespace pmdsim
