// The interface of the host and the shaders of the sweep, by the rules of interface.h.
#ifndef PMDSIM_SWEEP_INTERFACE_H
#define PMDSIM_SWEEP_INTERFACE_H

#include "shaders/light/source_windows.h"

#ifdef __cplusplus
namespace pmdsim::shader {
#endif

// Samples are taken in tiles of pixels, diodes in windows. A sample has a word for each bundle of a window's
// diodes, a bit for each diode.
// The tree over the items is implicit: `tree_width` items to a box, as many boxes to one above.
PMDSIM_CONSTANT tree_width = 8;
PMDSIM_CONSTANT tree_levels = 3;
// The table of half-planes: a line on the board goes by the direction of its normal and its distance from the
// centre.
PMDSIM_CONSTANT line_directions = 512;
PMDSIM_CONSTANT line_offsets = 256;

// The t2 of an item that is no edge between two triangles.
PMDSIM_CONSTANT item_boundary = 0xffffffffu; // an edge of one triangle alone
// No edge, but a triangle that the lens does not see: a, b, and c in place of the normal; c's packed rest in
// place of the other normal's x.
PMDSIM_CONSTANT item_hidden = 0xfffffffeu;

// A board of diodes. Board frame: its centre is the foot of the lens, z = 0 its plane, the scene lies at
// z < 0. Lengths in m.
struct SweepBoard {
  vec4 rows_hi[3]; // board_from_camera: of the rotation, w of the translation
  vec4 rows_lo[3];
  vec4 slope;       // of samples that are depth records, as in SampleGrid
  uvec4 shining[2]; // of each bundle of the window the diodes that shine
  vec4 supports_a;  // of diodes, centre and lens along +x, -x, +y, -y; not negative
  vec4 supports_b;  // along (1, 1), (-1, -1), (1, -1), (-1, 1), of unit length
  float lens_z;
  float radius;                  // of all diodes about the centre
  float rest_step;               // of what rounding to float took of an item's ends
  float highest;                 // z of diodes and lens, at most
  float diodes_low, diodes_high; // z of the diodes
  uint leaves_none;              // 1: no tile may be left out, as something stands between lens and diodes
  uint padding_1;
  uint level_first[tree_levels]; // in the boxes; level 0 is that over the items
  uint level_count[tree_levels];
  uvec2 chip;     // in, of depth records: ChipPlace
  uvec2 lit;      // uint a sample, in and out: the diodes that reach it
  uvec2 piercers; // Piercer[]: triangles that the straight ways from lens to diodes go through
  uint piercer_count;
  float nearest;        // z below which samples are in front of the board
  float line_margin;    // by which a line may be off for the table of half-planes to be right
  float world_rounding; // how far double rounding in the world's frame moves places
};

// The bounds of the straight ways from a tile's samples to the board: u . xy + k z <= s for eight directions
// u.
struct TileShaft {
  vec4 slopes_a, slopes_b; // k
  vec4 sights_a, sights_b; // likewise of the ways to the lens alone
  // Box around the samples, board frame; low > high where there is none. low.w: 1 where one of them may turn
  // its back to a diode. high.w: 1 where not all of them are in front of the board: nothing is left out then.
  vec4 low, high;
};

// The lists of tiles are made in rounds, so that they fit into memory: a round's lists begin in its own
// stretch of all their entries, and only the last of them goes beyond it. A frame with more entries is
// refused. Turns of all loops of an invocation, one for the end of each loop included; lavapipe ends them
// after 65,535, silently.
PMDSIM_CONSTANT most_sweep_steps = 50000;
PMDSIM_CONSTANT sweep_rounds = 16;
PMDSIM_CONSTANT entries_per_round = 1u << 23;

// A round: the workgroups that write its lists, those of the sweep over its tiles, and those of the exact
// sweep over the samples that the sweep leaves.
struct SweepRound {
  uint list_groups_x, list_groups_y, list_groups_z;
  uint tiles;
  uint tile_groups_x, tile_groups_y, tile_groups_z;
  uint padding;
  uint sample_groups_x, sample_groups_y, sample_groups_z;
  uint samples;
};

// Lists of the sweep. Behind it follow: for each tile the length of its list of edges and the entry where it
// begins, the same of its list of hidden triangles, then of each round its active tiles, then the samples
// that have to be decided exactly.
struct SweepWork {
  SweepRound rounds[sweep_rounds];
  uint entries; // of all tiles' lists
  uint lost;    // 1: a tile has no round, or loops were too long for all that had to be done
  uint padding_1, padding_2;
};

struct SweepConstants {
  Strip strip;
  uvec2 position;
  uvec2 ids;
  uvec2 planes;     // in: TrianglePlane[], of what the samples lie on
  uvec2 board;      // in: SweepBoard
  uvec2 shafts;     // TileShaft[]
  uvec2 work;       // SweepWork and its lists
  uvec2 entries;    // uint[], the tiles' lists of items
  uvec2 visibility; // out
  uvec2 exact;      // in: SweepPlanes[], of each item
  uint round;
  uint spare_entry; // of entries, for whatever is of no use
  uint tiles;
  uint plane;  // samples
  uint diodes; // of the window
  uint rank_bins;
};

// The planes of an edge's triangles, board frame: normal . P = offset; zero where there is none.
struct SweepPlanes {
  vec4 first_hi, first_lo, second_hi, second_lo;
};

// A triangle that the way from the lens to some diodes of a window goes through, board frame: there the
// light's place comes from one side of it to the other.
struct Piercer {
  vec4 plane_hi, plane_lo;         // normal . P = offset, the lens in front
  uint diodes[bundles_per_window]; // a bit each
};

#ifdef __cplusplus
static_assert(sizeof(SweepBoard) == 16 * 17 && sizeof(TileShaft) == 96 &&
              sizeof(SweepWork) == 48 * sweep_rounds + 16);
static_assert(sizeof(SweepConstants) <= 128);
} // namespace pmdsim::shader
#endif

#endif
