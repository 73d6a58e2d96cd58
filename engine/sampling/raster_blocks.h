#pragma once
// The frame cut into blocks that are rasterised on a plane each: the chip's own plane, whose fragments are
// the samples, or with distortion planes across the view, in whose fragments the samples search. Blocks are
// cut into strips that fit the device's buffers.

#include "engine/model/sensor.h"
#include "shaders/shared/interface.h"

#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// A part of the frame with its own list of triangles.
struct RasterBlock {
  glm::uvec2 first_pixel;        // column, row
  glm::uvec2 pixels;             // columns, rows
  glm::uvec2 fragments;          // columns, rows; of one tile where there are tiles
  glm::dmat3 raster_from_camera; // (x, y) = (h.x, h.y) / h.z fragments from the block's top left, h.z a depth
                                 // in metres
  bool distorted = false;        // the fragments are no samples, and all are there for every strip
  std::uint32_t first_vertex = 0, vertex_count = 0; // in Projection::vertices
};

// Whether pixels are filled in part, so that samples are no even grid over the frame. Each raster then holds
// the samples of equal place in their pixels, and there are S x S of them, tiles, each moved by
// raster_shift().
bool is_tiled(const Sensor &sensor);

// From the centre of a fragment to the sample (k_x, k_y) that it stands for, in fragments.
glm::dvec2 sample_shift(const Sensor &sensor, const glm::uvec2 &subsample);
// The same to the nearest 1/256, by which the raster is moved.
glm::vec2 raster_shift(const Sensor &sensor, const glm::uvec2 &subsample);

// Blocks of a sensor without distortion, as even as can be, of at most `block_fragments` fragments a side
// over all tiles.
std::vector<RasterBlock> chip_blocks(const Sensor &sensor, std::uint32_t block_fragments);

// Blocks of a sensor with distortion: rectangles of pixels with a plane of their own across the mean of their
// rays, so that neither wide views nor strong distortion waste many fragments. Their fragments are no wider
// than samples, and there is at least one more around every sample's. lens_fault() of the sensor is empty.
// They do not depend on strips, so that no bit does.
std::vector<RasterBlock> distorted_blocks(const Sensor &sensor, std::uint32_t block_fragments);

struct PlannedStrip {
  shader::Strip strip;
  std::uint32_t block; // index into Projection::blocks
};

// Whole rows of the blocks, each strip of at most `max_samples` samples but at least one row of a block.
std::vector<PlannedStrip> plan_strips(const Sensor &sensor, const std::vector<RasterBlock> &blocks,
                                      std::uint32_t max_samples);

// Columns and rows of fragments that are rasterised for a strip of `block`, all tiles together.
glm::uvec2 strip_fragments(const shader::Strip &strip, const RasterBlock &block);

// Invocations for `pixels` pixels: whole workgroups, of which the last is spare. Invocations that fill up the
// last workgroup of a list of pixels work on its places.
std::uint32_t padded(std::uint32_t pixels);

} // namespace pmdsim
