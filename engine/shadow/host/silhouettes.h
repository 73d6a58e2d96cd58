#pragma once
// The data of the host's sweep, as plain arrays: its loops are compiled once for each instruction set, so
// they share no code with the rest of the program.

#include "engine/sampling/host/sample_source.h"
#include "shaders/shadow/sweep_interface.h"

#include <cstddef>
#include <cstdint>

namespace pmdsim {

// The rows of an item of the sweep (sweep_items.h). Places are in the board's frame, m.
enum ItemRow : std::uint32_t {
  row_ax,
  row_ay,
  row_az, // ends of an edge; the first two corners of a hidden triangle
  row_bx,
  row_by,
  row_bz,
  row_cx,
  row_cy,
  row_cz, // the first triangle's unit normal; the third corner
  row_dx,
  row_dy,
  row_dz, // the second triangle's unit normal; the third corner's rest
  row_rest_ax,
  row_rest_ay,
  row_rest_az, // what rounding to float took
  row_rest_bx,
  row_rest_by,
  row_rest_bz,
  row_first,
  row_second, // triangles; no_id
  row_sides,  // SweepItem's, of the first triangle in bits 0, 1, of the second in 2, 3
  row_number, // of the item
  item_rows
};

constexpr std::uint32_t items_per_block = 16;

// Floats by their bits.
struct alignas(64) ItemBlock {
  std::int32_t rows[item_rows][items_per_block];
};

// Boxes around as many blocks of items, or of boxes.
struct alignas(64) BoxBlock {
  float low[3][items_per_block], high[3][items_per_block];
};

// A tree over blocks of items. Level 0 is around these, the last one has a single block.
constexpr std::uint32_t most_box_levels = 8;
struct ItemTree {
  const ItemBlock *items = nullptr;
  const BoxBlock *boxes[most_box_levels] = {};
  std::uint32_t levels = 0;
  std::uint32_t blocks = 0; // of items
};

// The planes of an edge's triangles, board frame: normal . p = offset; zeros where there is none.
struct EdgePlanes {
  double first[4], second[4];
};

// The most diodes that a window has.
constexpr std::uint32_t most_diodes = shader::bundles_per_window * shader::diodes_per_bundle;
// With two vectors to spare, of the widest: a pair that begins behind the last diode counts in them, nothing.
constexpr std::uint32_t diode_room = most_diodes + 32;

// Angles as whole numbers, so many to a quadrant, and the bins that those fall into.
constexpr std::int32_t fine_turn_bits = 22, bin_bits = 13, bin_mask = (1 << bin_bits) - 1;
constexpr std::uint32_t angle_bins = 4u << (fine_turn_bits - bin_bits);

// The ranks of a bin of angles: how many diodes have smaller angles than its first class, how many with that
// class's, whether more classes begin within the bin, and where in the bin that class begins.
constexpr std::int32_t rank_bits = 9, rank_mask = (1 << rank_bits) - 1, more_classes = 1 << 2 * rank_bits,
                       threshold_shift = 2 * rank_bits + 1;
static_assert(most_diodes <= rank_mask && threshold_shift + bin_bits == 32);

// A window of diodes on its board.
struct SilhouetteBoard {
  // The diodes in the order of their angles about the centre, and where each bit's diode is in that order.
  alignas(64) float x_m[diode_room], y_m[diode_room];
  alignas(64) double exact_m[3][most_diodes];
  alignas(64) std::int32_t rank_of_bit[most_diodes];
  bool ranks_are_bits; // each is its own
  // Classes of one angle, by the number of diodes of smaller angles: a class's angle, with a last one above
  // all, and that number for the next class.
  alignas(64) float rank_turn[most_diodes + 1];
  std::int32_t next_rank[most_diodes + 1];
  alignas(64) std::int32_t bin_ranks[angle_bins];
  // The members of SweepBoard, and more.
  double rotation[3][3], translation_m[3]; // board_from_camera
  float supports[8];                       // +x, -x, +y, -y, (1, 1), (-1, -1), (1, -1), (-1, 1)
  double world_rounding_m;
  ItemTree edges, hidden;
  const EdgePlanes *planes; // beside the edges
  const shader::Piercer *piercers;
  std::uint32_t shining[shader::bundles_per_window];
  std::uint32_t diodes; // 32 a bundle
  std::uint32_t bundles;
  std::uint32_t piercer_count;
  float lens_z, radius, highest, diodes_low, diodes_high, nearest;
  bool leaves_none; // no tile may be left out
  bool exact_only;  // every sample is decided by tetrahedra
  bool lens_apart;  // from the board's plane
  bool all_facing;  // nothing turns away from a diode
};

// The results for a tile. Bits are as StripBuffers::visibility has them, word by word of a sample.
struct TileBits {
  std::uint32_t words[shader::tile_samples][shader::bundles_per_window];
  std::uint32_t index[shader::tile_samples]; // of the sample, where it is there
  bool is_there[shader::tile_samples], sees[shader::tile_samples];
  bool is_shaded; // some diode does not reach some sample that sees anything: then the following is there
  std::uint32_t missing[shader::tile_samples]; // diodes that shine, and do not reach the sample
};

// A worker's memory: room for every block of items, and for every one of hidden triangles twice.
struct ListedBlock {
  std::uint32_t block, bits;
};
struct TileMemory {
  ListedBlock *edges, *hidden, *hidden_nearby;
};

// One for each instruction set.
using DecideTile = void (*)(const SilhouetteBoard &board, const SampleSource &samples, std::uint32_t tile,
                            const TileMemory &memory, TileBits &bits);

} // namespace pmdsim
