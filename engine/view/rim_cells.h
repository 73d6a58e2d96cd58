#pragma once
// Where the nearest shape at a fragment's centre does not tell what else is seen in the fragment: the cells
// of distorted blocks that rims cross, each with all the shapes that may be seen in it. A rim is where a
// surface ends or folds back, seen from the lens: an edge without a neighbour beyond it, a disc's circle; and
// anywhere on a surface with holes. All other cells see unbroken surfaces, on which a search can walk.

#include "engine/sampling/raster_blocks.h"
#include "engine/view/camera_scene.h"
#include "shaders/shared/interface.h"

#include <cstdint>
#include <vector>

namespace pmdsim {

struct RimCells {
  std::vector<shader::RimCell> cells;      // block after block, each row by row
  std::vector<std::uint32_t> end_of_block; // in `cells`
  // Each cell's candidates, the nearest first, and after them one of no shape. A cell that more than 16,384
  // shapes cross has the nearest ones.
  std::vector<shader::RimCandidate> candidates;
};

// `corners`: the scene's, as triangle_corners() gives them.
RimCells find_rim_cells(const CameraScene &camera, const Scene &scene,
                        const std::vector<shader::TriangleCorners> &corners,
                        const std::vector<RasterBlock> &blocks);

} // namespace pmdsim
