// The loops of the host's sweep over a tile. Compiled once for each instruction set, PMDSIM_INSTRUCTION_SET
// its name; see engine/CMakeLists.txt. They do what the shaders of the sweep do, a lane an edge in place of a
// sample.
#include "engine/shadow/host/pairs.h"

#include <bit>
#include <cstdint>
#include <cstring>

namespace pmdsim::PMDSIM_INSTRUCTION_SET {
namespace {

// The data that a tile's samples have in common.
struct Tile {
  const SilhouetteBoard &board;
  ListedBlock *edges, *hidden, *hidden_nearby; // the latter of neighbouring samples
  std::uint32_t edge_blocks, hidden_blocks, hidden_blocks_nearby;
  ItemList items;                             // of one segment
  std::uint32_t gathered_first, gathered_end; // the blocks in it
};

void gather_segment(Tile &tile, std::uint32_t first) {
  if (tile.gathered_end > 0 && tile.gathered_first == first)
    return;
  tile.gathered_first = first;
  tile.gathered_end = gather(tile.board.edges, tile.edges, first, tile.edge_blocks, tile.items);
}

// By the tetrahedra of sample, lens, diode and each end: for any sample, and diodes anywhere.
void decide_exactly(Tile &tile, const Sample &sample, int hidden, Sweep &sweep) {
  const SilhouetteBoard &board = tile.board;
  for (std::int32_t &count : sweep.counts)
    count = hidden;
  for (std::uint32_t i = 0; i < board.piercer_count; ++i) {
    const shader::Piercer &piercer = board.piercers[i];
    double plane[4];
    for (int k = 0; k < 4; ++k)
      plane[k] = static_cast<double>(piercer.plane_hi[k]) + static_cast<double>(piercer.plane_lo[k]);
    const int side = exact_side(plane, sample, board);
    for (std::uint32_t d = 0; d < board.diodes; ++d)
      sweep.counts[board.rank_of_bit[d]] += (piercer.diodes[d / 32] >> d % 32 & 1u) != 0 ? side : 0;
  }
  const Exact3 lens{-sample.exact[0], -sample.exact[1], static_cast<double>(board.lens_z) - sample.exact[2]};
  Shaft shaft = no_shaft();
  add_sample(sample, board, shaft);
  const Ways ways = ways_of(shaft, board);
  ItemList list;
  for (std::uint32_t first = 0; first < tile.edge_blocks; first = tile.gathered_end) {
    gather_segment(tile, first);
    narrow(tile.items, ways, may_matter, list);
    const Rows items = list.all();
    for (int i = 0; i < list.count; ++i) {
      if (static_cast<std::uint32_t>(list.rows[row_first][i]) == sample.own ||
          static_cast<std::uint32_t>(list.rows[row_second][i]) == sample.own)
        continue;
      if (const int weight = exact_weight(items, i, sample, board); weight != 0)
        cross_triangles(exact_place(items, row_ax, row_rest_ax, i, sample),
                        exact_place(items, row_bx, row_rest_bx, i, sample), lens, weight, sample, board,
                        sweep.counts);
    }
  }
}

// The sample's bits; returns false where a count below zero tells that something was left out. Such a count
// means nothing of a diode behind the sample's own surface. `faces`: null where it faces all diodes.
bool find_bits(const Sweep &sweep, const std::int32_t *faces, const SilhouetteBoard &board,
               std::uint32_t *words) {
  std::uint32_t below_zero = 0;
  std::memset(words, 0, shader::bundles_per_window * sizeof(*words));
  const auto add = [&](std::uint32_t d, const Ints &count, const Ints &facing) {
    words[d / 32] |= bits_of((count == 0) & facing) << d % 32;
    below_zero |= bits_of((count < 0) & facing);
  };
  if (board.ranks_are_bits && !faces)
    for (std::uint32_t d = 0; d < board.diodes; d += lanes)
      add(d, load<Ints>(sweep.counts + d), all(-1));
  else if (board.ranks_are_bits)
    for (std::uint32_t d = 0; d < board.diodes; d += lanes)
      add(d, load<Ints>(sweep.counts + d), load<Ints>(faces + d));
  else
    for (std::uint32_t d = 0; d < board.diodes; d += lanes) {
      const Ints ranks = load<Ints>(board.rank_of_bit + d);
      add(d, gathered(sweep.counts, ranks), faces ? gathered(faces, ranks) : all(-1));
    }
  return below_zero == 0;
}

void finish(Tile &tile, const Sample &sample, Sweep &sweep, std::uint32_t *words) {
  const SilhouetteBoard &board = tile.board;
  const bool turns_away = !board.all_facing && may_turn_away(sample, board);
  const int hidden = count_hidden(board.hidden, tile.hidden_nearby, tile.hidden_blocks_nearby, sample, board),
            base = sweep.base + hidden;
  if (!sweep.is_touched && !sweep.is_unclear && !turns_away && base == 0)
    return;
  alignas(64) std::int32_t facing[most_diodes];
  const std::int32_t *const faces = turns_away ? facing : nullptr;
  if (turns_away)
    find_facing(sample, board, facing);
  touch(sweep);
  if (base != 0)
    for (std::int32_t &count : sweep.counts)
      count += base;
  if (!sweep.is_unclear && find_bits(sweep, faces, board, words))
    return;
  decide_exactly(tile, sample, hidden, sweep);
  find_bits(sweep, faces, board, words);
}

// Neighbouring samples of a tile.
void decide_block(Tile &tile, const TileSamples &of_tile, int block, const Shaft &shaft, TileBits &bits) {
  const SilhouetteBoard &board = tile.board;
  if (!shaft.any)
    return;
  Sample samples[block_samples];
  Sweep sweeps[block_samples];
  for (int k = 0; k < block_samples; ++k) {
    samples[k] = sample_of(of_tile, k * tile_blocks + block);
    if (samples[k].sees)
      begin_sweep(samples[k], board, sweeps[k]);
  }
  const Ways ways = ways_of(shaft, board);
  ItemList list;
  Pairs pairs;
  for (std::uint32_t first = 0; first < tile.edge_blocks && !board.exact_only; first = tile.gathered_end) {
    gather_segment(tile, first);
    narrow(tile.items, ways, may_matter, list);
    for (int k = 0; k < block_samples && list.count > 0; ++k)
      if (samples[k].sees && !sweeps[k].is_unclear)
        sweep_over(list, samples[k], board, pairs, sweeps[k]);
  }
  tile.hidden_blocks_nearby = narrow(board.hidden, tile.hidden, tile.hidden_blocks, sights_of(shaft, board),
                                     may_hide, tile.hidden_nearby);
  for (int k = 0; k < block_samples; ++k)
    if (samples[k].sees)
      finish(tile, samples[k], sweeps[k], bits.words[number_of(k * tile_blocks + block)]);
}

void count_missing(const SilhouetteBoard &board, TileBits &bits) {
  std::uint32_t any = 0;
  for (std::uint32_t i = 0; i < shader::tile_samples; ++i) {
    bits.missing[i] = 0;
    for (std::uint32_t w = 0; bits.sees[i] && w < board.bundles; ++w)
      bits.missing[i] += static_cast<std::uint32_t>(std::popcount(board.shining[w] & ~bits.words[i][w]));
    any |= bits.missing[i];
  }
  bits.is_shaded = any != 0;
}

void decide_tile(const SilhouetteBoard &board, const SampleSource &source, std::uint32_t number,
                 const TileMemory &memory, TileBits &bits) {
  TileSamples samples;
  std::memset(bits.words, 0xff, sizeof(bits.words));
  bits.is_shaded = false;
  if (!find_samples(board, source, number, samples, bits))
    return;
  if (!board.all_facing)
    find_normals(board, source, samples);
  const bool turns_away = !board.all_facing && may_turn_away(samples, board);
  Shaft of_blocks[tile_blocks];
  const Shaft shaft = find_shafts(samples, board, of_blocks);
  const Ways ways = ways_of(shaft, board);
  Tile tile{board,
            memory.edges,
            memory.hidden,
            memory.hidden_nearby,
            list_items(board.edges, ways, may_matter, memory.edges),
            list_items(board.hidden, sights_of(shaft, board), may_hide, memory.hidden),
            0,
            {},
            0,
            0};
  if (tile.edge_blocks + tile.hidden_blocks == 0 && !turns_away && !board.leaves_none)
    return;
  for (int block = 0; block < tile_blocks; ++block)
    decide_block(tile, samples, block, of_blocks[block], bits);
  count_missing(board, bits);
}

} // namespace

extern const DecideTile decide_silhouettes;
const DecideTile decide_silhouettes = decide_tile;

} // namespace pmdsim::PMDSIM_INSTRUCTION_SET
