#pragma once
// A strip's samples as the shadow passes take them: in tiles.

#include "engine/sampling/raster_blocks.h"
#include "shaders/shared/interface.h"

#include <cstdint>
#include <span>

namespace pmdsim {

std::uint32_t tiles_across(std::uint32_t pixels);
std::uint32_t tile_count(const shader::Strip &strip);
// The most of any of the strips.
std::uint32_t largest_tile_count(std::span<const PlannedStrip> strips);

} // namespace pmdsim
