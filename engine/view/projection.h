#pragma once
// Triangles projected onto the raster blocks in double: clipped to each and snapped to the raster's grid of
// 1/256 fragment. The device then rasterises numbers that it can represent exactly, so neither the size of a
// strip nor a device's clipper can change which samples a triangle covers.

#include "engine/sampling/raster_blocks.h"
#include "engine/view/camera_scene.h"
#include "engine/view/cell_rows.h"
#include "shaders/shared/interface.h"

#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

namespace pmdsim {

// Points nearer to a block's plane through the lens are not seen in the block.
constexpr double nearest_depth_m = 1e-7;

struct Projection {
  std::vector<RasterBlock> blocks; // together they are the frame
  std::vector<shader::RasterVertex> vertices;
  std::vector<VisibleBox> visible; // some 1,000 at most, whatever the number of triangles
};

// The part of a shape that the lens sees in a block, in double and without the raster's grid: the outline on
// the block's raster, less the part behind the lens, and the depths; nothing where all lies there.
struct Seen {
  Outline outline;
  double nearest_m = std::numeric_limits<double>::infinity(), farthest_m = 0.0;
};

// `corners_m`: those of a triangle, or of a line, in the camera frame.
Seen seen_in(const RasterBlock &block, std::span<const glm::dvec3> corners_m);

// `blocks` without their vertices.
Projection project(const CameraScene &camera, std::vector<RasterBlock> blocks);

} // namespace pmdsim
