#include "engine/shadow/host/host_sweep.h"

#include "engine/model/instruction_sets.h"
#include "engine/model/turn.h"
#include "engine/sampling/host/host_samples.h"
#include "engine/shadow/host/silhouette_tree.h"
#include "engine/shadow/sweep_tables.h"
#include "engine/shadow/tiles.h"
#include "engine/vulkan/shader_module.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_access.hpp>
#include <limits>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::DecideTile, decide_silhouettes)

namespace pmdsim {

namespace {

EdgePlanes exact_planes(const shader::SweepPlanes &planes) {
  EdgePlanes exact{};
  for (glm::length_t i = 0; i < 4; ++i) {
    exact.first[i] = static_cast<double>(planes.first_hi[i]) + static_cast<double>(planes.first_lo[i]);
    exact.second[i] = static_cast<double>(planes.second_hi[i]) + static_cast<double>(planes.second_lo[i]);
  }
  return exact;
}

// Classes begin at ranks, in the order of their angles.
void place_classes(const std::vector<std::pair<float, std::int32_t>> &classes, std::int32_t diodes,
                   SilhouetteBoard &to) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  const auto of = [&](std::size_t i) {
    return i < classes.size() ? classes[i] : std::pair(infinite, diodes);
  };
  for (std::size_t i = 0; i <= classes.size(); ++i) {
    const auto rank = static_cast<std::size_t>(of(i).second);
    to.rank_turn[rank] = of(i).first;
    to.next_rank[rank] = of(i + 1).second;
  }
  std::size_t first = 0;
  for (std::uint32_t bin = 0; bin < angle_bins; ++bin) {
    const auto begins_before = [&](std::size_t i, std::uint32_t end) {
      return of(i).first * (angle_bins / 4.0f) < static_cast<float>(end);
    };
    while (begins_before(first, bin))
      ++first;
    const bool has_more =
        bin + 1 < angle_bins ? begins_before(first + 1, bin + 1) : first + 1 < classes.size();
    const std::int32_t threshold =
        begins_before(first, bin + 1)
            ? static_cast<std::int32_t>(of(first).first * static_cast<float>(1 << fine_turn_bits)) & bin_mask
            : bin_mask;
    to.bin_ranks[bin] = of(first).second | of(first + 1).second << rank_bits | (has_more ? more_classes : 0) |
                        static_cast<std::int32_t>(static_cast<std::uint32_t>(threshold) << threshold_shift);
  }
}

void place_diodes(const Board &board, const std::vector<glm::dvec3> &places_m, SilhouetteBoard &to) {
  std::vector<std::pair<float, std::int32_t>> ordered;
  for (std::size_t d = 0; d < places_m.size(); ++d) {
    const glm::vec2 place(board.in_frame(places_m[d]));
    ordered.emplace_back(turn_of(place), static_cast<std::int32_t>(d));
  }
  std::ranges::sort(ordered);
  to.diodes = static_cast<std::uint32_t>(ordered.size());
  std::vector<std::pair<float, std::int32_t>> classes;
  for (std::size_t rank = 0; rank < ordered.size(); ++rank) {
    const auto &[turn, diode] = ordered[rank];
    const glm::dvec3 place_m = board.in_frame(places_m[static_cast<std::size_t>(diode)]);
    for (std::size_t k = 0; k < 3; ++k)
      to.exact_m[k][rank] = place_m[static_cast<glm::length_t>(k)];
    to.x_m[rank] = static_cast<float>(place_m.x);
    to.y_m[rank] = static_cast<float>(place_m.y);
    to.rank_of_bit[static_cast<std::size_t>(diode)] = static_cast<std::int32_t>(rank);
    if (classes.empty() || turn > classes.back().first + same_turn)
      classes.emplace_back(turn, static_cast<std::int32_t>(rank));
  }
  to.ranks_are_bits = std::ranges::is_sorted(ordered, {}, &std::pair<float, std::int32_t>::second);
  place_classes(classes, static_cast<std::int32_t>(ordered.size()), to);
}

void describe(const Board &board, SilhouetteBoard &to) {
  for (glm::length_t row = 0; row < 3; ++row) {
    for (glm::length_t column = 0; column < 3; ++column)
      to.rotation[row][column] = board.rotation[column][row];
    to.translation_m[row] = board.translation_m[row];
  }
  std::ranges::transform(board.supports_m, to.supports,
                         [](double support_m) { return static_cast<float>(support_m); });
  to.lens_z = static_cast<float>(board.lens_z_m);
  to.radius = static_cast<float>(board.radius_m);
  to.highest = static_cast<float>(std::max(board.highest_m, board.lens_z_m));
  to.diodes_low = static_cast<float>(board.lowest_m);
  to.diodes_high = static_cast<float>(board.highest_m);
  to.nearest = static_cast<float>(board.nearest_in_front_m());
  to.lens_apart = std::abs(board.lens_z_m) > 1e-9;
}

} // namespace

struct HostSweep::State {
  struct OnBoard {
    SilhouetteTree edges, hidden;
    std::vector<EdgePlanes> planes;
  };
  // A part of a window, whose diodes are few enough to be swept at once.
  struct Sweep {
    std::size_t window;
    WindowPart part;
    std::vector<shader::Piercer> piercers = {};
    std::unique_ptr<SilhouetteBoard> board = nullptr;
    // Tiles whose words say already that every diode reaches all of their samples, in a strip of the extent
    // below.
    std::vector<std::uint8_t> filled = {};
  };

  const StripBuffers &buffers;
  HostSamples samples;
  bool all_facing, fills_all, clears_bits;
  std::uint32_t shining = 0; // diodes of all windows
  glm::uvec2 filled_extent = {};
  std::vector<std::uint8_t> block_kinds = {};
  std::size_t most_blocks = 1;
  DecideTile decide_tile;
  std::vector<std::unique_ptr<OnBoard>> boards;
  std::vector<Sweep> sweeps; // window by window

  std::size_t window_count() const { return sweeps.back().window + 1; }
  void add_board(const PassSetup &on, const Board &board, const SweepItems &items,
                 const SourceGroups &groups);
  void begin_tiles(const shader::Strip &strip);
  void decide(const shader::Strip &strip, Sweep &sweep);
  void store(const shader::Strip &strip, Sweep &sweep, std::uint32_t tile, const TileBits &bits);
  void store_kinds(bool is_first, std::uint32_t tile, std::uint32_t tiles_across, const TileBits &bits);
};

void HostSweep::State::add_board(const PassSetup &on, const Board &board, const SweepItems &items,
                                 const SourceGroups &groups) {
  auto on_board = std::make_unique<OnBoard>();
  on_board->edges = silhouette_tree(items.edges, items.rest_step);
  on_board->hidden = silhouette_tree(items.hidden, items.rest_step);
  std::ranges::transform(items.planes, std::back_inserter(on_board->planes), exact_planes);
  most_blocks = std::max({most_blocks, on_board->edges.items.size(), on_board->hidden.items.size()});
  for (const std::size_t sweep : board.windows) {
    Sweep &of = sweeps[sweep];
    const std::vector<glm::dvec3> places_m = places_of(of.part.runs, groups);
    of.piercers = find_piercers(board, items.in_the_way, places_m);
    of.board = std::make_unique<SilhouetteBoard>();
    SilhouetteBoard &to = *of.board;
    describe(board, to);
    place_diodes(board, places_m, to);
    to.world_rounding_m = on.scene.world_rounding_m;
    to.leaves_none = !items.in_the_way.empty();
    to.exact_only = !board.is_flat || to.leaves_none;
    to.all_facing = all_facing;
    to.bundles = of.part.runs.bundles;
    const std::vector<std::uint32_t> bits = diodes_of(of.part.runs, groups).bits;
    std::ranges::copy(bits, to.shining);
    for (const std::uint32_t of_bundle : bits)
      shining += static_cast<std::uint32_t>(std::popcount(of_bundle));
    to.edges = on_board->edges.view();
    to.hidden = on_board->hidden.view();
    to.planes = on_board->planes.data();
    to.piercers = of.piercers.data();
    to.piercer_count = static_cast<std::uint32_t>(of.piercers.size());
  }
  boards.push_back(std::move(on_board));
}

// Other windows' words are in the same place, and shapes with holes take bits away.
void HostSweep::State::begin_tiles(const shader::Strip &strip) {
  const glm::uvec2 extent(strip.columns, strip.rows);
  if (window_count() > 1 || clears_bits || filled_extent != extent)
    for (Sweep &sweep : sweeps)
      sweep.filled.assign(tile_count(sample_strip(strip, samples.are_records())), 0);
  filled_extent = extent;
}

void HostSweep::State::store(const shader::Strip &strip, Sweep &sweep, std::uint32_t tile,
                             const TileBits &bits) {
  const std::size_t plane = sample_count(strip), first = sweep.part.first_bundle;
  auto *const words = buffers.visibility.mapped_as<std::uint32_t>() + first * plane;
  auto *const lit = buffers.lit.mapped_as<std::uint32_t>();
  const bool fills = bits.is_shaded || (fills_all && sweep.filled[tile] == 0);
  const bool is_first = &sweep == &sweeps.front();
  sweep.filled[tile] = fills_all && !bits.is_shaded;
  for (std::size_t i = 0; i < shader::tile_samples; ++i) {
    if (!bits.is_there[i])
      continue;
    const std::size_t at = bits.index[i];
    if (fills)
      for (std::size_t w = 0; w < sweep.board->bundles; ++w)
        words[w * plane + at] = bits.words[i][w];
    lit[at] = (is_first ? shining : lit[at]) - (bits.is_shaded ? bits.missing[i] : 0);
  }
}

// For depth records, whose blocks are a tile's rows.
void HostSweep::State::store_kinds(bool is_first, std::uint32_t tile, std::uint32_t tiles_across,
                                   const TileBits &bits) {
  static_assert(shader::block_samples == shader::tile_side);
  for (std::uint32_t row = 0; row < shader::tile_side; ++row) {
    const std::uint32_t first = row * shader::tile_side;
    if (!bits.is_there[first])
      return;
    bool sees = false, shaded = false;
    for (std::uint32_t i = first; i < first + shader::tile_side; ++i) {
      sees = sees || (bits.is_there[i] && bits.sees[i]);
      shaded = shaded || (bits.is_there[i] && bits.is_shaded && bits.missing[i] > 0);
    }
    std::uint8_t &kind =
        block_kinds[(tile / tiles_across * shader::tile_side + row) * tiles_across + tile % tiles_across];
    if (is_first || shaded)
      kind = static_cast<std::uint8_t>(!sees    ? shader::blocks_empty
                                       : shaded ? shader::blocks_shaded
                                                : shader::blocks_lit);
  }
}

HostSweep::HostSweep(const PassSetup &on, const Occluders &occluders, const CameraScene &camera,
                     const Scene &scene, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                     const std::optional<ChipGrid> &records, bool fills_all)
    : state_(
          std::make_unique<State>(State{.buffers = on.buffers,
                                        .samples = {on.buffers, on.scene.planes, on.sensor, records,
                                                    vulkan::uses_fp64(on.device, on.options.precision)},
                                        .all_facing = on.model.backscatter == shader::backscatter_flat,
                                        .fills_all = fills_all,
                                        .clears_bits = !occluders.with_holes.empty(),
                                        .decide_tile = widest_decide_silhouettes(on.options.host_vector_bits),
                                        .boards = {},
                                        .sweeps = {}})) {
  if (!on.buffers.visibility.is_mapped() || !on.buffers.lit.is_mapped())
    throw std::logic_error("the host does not share the device's memory");
  State &state = *state_;
  std::vector<SourceWindow> swept;
  for (std::size_t window = 0; window < windows.size(); ++window)
    for (const WindowPart &part : parts_of(windows[window], groups)) {
      state.sweeps.push_back({.window = window, .part = part});
      swept.push_back(part.runs);
    }
  // Where a part is shaded, the words of all are read.
  state.fills_all = fills_all || swept.size() > windows.size();
  for (const Board &board : find_boards(groups, swept))
    state.add_board(on, board, sweep_items(board, occluders, camera, scene), groups);
}

HostSweep::~HostSweep() = default;

void HostSweep::State::decide(const shader::Strip &strip, Sweep &sweep) {
  const SampleSource source = samples.of(strip);
  const bool is_first = &sweep == &sweeps.front() || (&sweep - 1)->window != sweep.window;
  struct Memory {
    std::vector<ListedBlock> edges, hidden, hidden_nearby;
    TileBits bits;
  };
  tbb::enumerable_thread_specific<Memory> memory([&] {
    const std::vector<ListedBlock> all(most_blocks + 1);
    return Memory{all, all, all, {}};
  });
  tbb::parallel_for(
      tbb::blocked_range<std::uint32_t>(0, tile_count(source.strip), 4), [&](const auto &range) {
        Memory &own = memory.local();
        for (std::uint32_t tile = range.begin(); tile < range.end(); ++tile) {
          decide_tile(*sweep.board, source, tile,
                      {own.edges.data(), own.hidden.data(), own.hidden_nearby.data()}, own.bits);
          store(strip, sweep, tile, own.bits);
          if (samples.are_records())
            store_kinds(is_first, tile, tiles_across(source.strip.columns), own.bits);
        }
      });
}

void HostSweep::decide(const shader::Strip &strip, std::size_t window) const {
  State &state = *state_;
  state.begin_tiles(strip);
  const SampleSource source = state.samples.of(strip);
  if (state.samples.are_records())
    state.block_kinds.resize(std::size_t{tiles_across(source.strip.columns)} * source.strip.rows);
  for (State::Sweep &sweep : state.sweeps)
    if (sweep.window == window)
      state.decide(strip, sweep);
}

std::span<const std::uint8_t> HostSweep::block_kinds() const { return state_->block_kinds; }

} // namespace pmdsim
