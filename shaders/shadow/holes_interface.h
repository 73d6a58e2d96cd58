// The interface of the host and the shaders of the pass over shapes with holes, by the rules of interface.h.
#ifndef PMDSIM_HOLES_INTERFACE_H
#define PMDSIM_HOLES_INTERFACE_H

#include "shaders/light/source_windows.h"
#include "shaders/shadow/occluder.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

// Shapes lie along a curve, so that those that follow each other lie close together: `hole_width` shapes to a
// box, as many boxes to a block, and `hole_blocks` blocks to a range. A dispatch is over one range: lavapipe
// ends all loops of an invocation after 65,535 turns together, silently, and a shape takes 175 at most.
PMDSIM_CONSTANT hole_width = 8;
PMDSIM_CONSTANT hole_blocks = 4;
PMDSIM_CONSTANT hole_range = hole_width * hole_width * hole_blocks; // shapes of a range
PMDSIM_CONSTANT hole_texels = 9;                                    // of a shape
// So many ranges have lists of tiles at a time.
PMDSIM_CONSTANT hole_batch = 16;

// The data that the shaders look up about the scene and a window of diodes.
struct HolesWindow {
  DiodeBox box;     // around the diodes
  vec4 slope;       // of samples that are depth records, as in SampleGrid
  uvec4 shining[2]; // of each bundle the diodes that shine
  uvec2 chip;       // in, of depth records: ChipPlace
  uvec2 paints;     // ShapePaint[]
  uvec2 surfaces;   // SurfacePaint[]
  uvec2 bundles;    // BundleDiodes[]
  uint shapes;
  uint first_block, first_range; // in the boxes, behind those over the shapes
  float world_rounding;          // how far double rounding in the world's frame moves places, m
};

// The box around a tile's samples, camera frame, m; low > high where the tile sees nothing.
struct TileBox {
  vec4 low, high;
};

// The tiles of each range follow.
struct HolesWork {
  WorkList ranges[hole_batch];
};

struct HolesConstants {
  Strip strip;
  uvec2 position;
  uvec2 ids;
  uvec2 window;     // in: HolesWindow
  uvec2 boxes;      // TileBox[]
  uvec2 work;       // HolesWork and its lists
  uvec2 visibility; // in and out
  uvec2 lit;        // in and out: uint a sample, the diodes that reach it
  uint first_range; // of those that have lists
  uint range;       // among these
  uint tiles;
  uint plane; // samples
};

#ifdef __cplusplus
static_assert(175 * hole_range < 60000);
static_assert(sizeof(HolesWindow) == 128 && sizeof(HolesConstants) == 104);
} // namespace pmdsim::shader
#endif

#endif
