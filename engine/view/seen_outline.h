#pragma once
// What the lens sees of a shape in a block, in double and without the raster's grid.

#include "engine/sampling/raster_blocks.h"
#include "engine/view/cell_rows.h"

#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace pmdsim {

// The outline on the block's raster, less what lies behind the lens, and the depths; nothing where all does.
struct Seen {
  Outline outline;
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0.0;
};

// Of a triangle, or of a line, whose corners are in the camera frame.
Seen seen_in(const RasterBlock &block, std::span<const glm::dvec3> corners_m);

} // namespace pmdsim
