#pragma once
// Triangles projected onto the chip in double: clipped to the frame, cut into raster blocks, snapped to the
// raster's grid of 1/256 sample. The device then rasterises numbers that it can represent exactly, so neither
// the size of a strip nor a device's clipper can change which sample sees which triangle.

#include "engine/passes/camera_scene.h"
#include "engine/sensor.h"
#include "shaders/interface.h"

#include <vector>

namespace pmdsim {

// A part of the frame with its own list of triangles; `block_samples` wide and high at most.
struct RasterBlock {
  glm::uvec2 first_pixel; // column, row
  glm::uvec2 pixels;      // columns, rows
  std::uint32_t first_vertex;
  std::uint32_t vertex_count;
};

// Holds what is visible of some consecutive triangles, before one hides another.
struct VisibleBox {
  glm::dvec3 low_m; // camera frame
  glm::dvec3 high_m;
};

struct Projection {
  std::vector<RasterBlock> blocks; // row-major; together they are the frame
  std::vector<shader::RasterVertex> vertices;
  std::vector<VisibleBox> visible; // some 1,000 at most, whatever the number of triangles
};

Projection project(const CameraScene &camera, const Sensor &sensor, std::uint32_t block_samples);

} // namespace pmdsim
