#include "engine/shadow/sweep_pass.h"

#include "engine/shadow/sweep_items.h"
#include "engine/shadow/sweep_tables.h"
#include "engine/shadow/sweep_tree.h"
#include "engine/shadow/tiles.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/compute_pipeline.h"
#include "engine/vulkan/float_pair.h"
#include "engine/vulkan/texel_buffers.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_access.hpp>
#include <string_view>

namespace pmdsim {
namespace {

using vulkan::Buffer;

constexpr std::uint32_t texel_buffers = 7; // of sweep.glsl

// With so many items, 256 diodes and subgroups of 8, no loop is too long, and all lists have room.
constexpr std::uint32_t fewest_to_lose = 400;

Buffer sweep_storage(const vulkan::Device &device, vk::DeviceSize bytes, vk::BufferUsageFlags more = {}) {
  return {device, bytes, vk::BufferUsageFlagBits::eStorageBuffer | more, vulkan::Memory::device};
}

shader::SweepBoard board_record(const Board &board, const SweepItems &items, const TreeLevels &levels,
                                double world_rounding_m) {
  shader::SweepBoard record{};
  for (glm::length_t row = 0; row < 3; ++row) {
    const DoublePair4 pair(glm::row(board.rotation, row), board.translation_m[row]);
    record.rows_hi[static_cast<std::size_t>(row)] = pair.hi;
    record.rows_lo[static_cast<std::size_t>(row)] = pair.lo;
  }
  for (glm::length_t i = 0; i < 4; ++i) {
    record.supports_a[i] = static_cast<float>(board.supports_m[static_cast<std::size_t>(i)]);
    record.supports_b[i] = static_cast<float>(board.supports_m[static_cast<std::size_t>(i) + 4]);
  }
  record.lens_z = static_cast<float>(board.lens_z_m);
  record.radius = static_cast<float>(board.radius_m);
  record.rest_step = items.rest_step;
  record.highest = static_cast<float>(std::max(board.highest_m, board.lens_z_m));
  record.diodes_low = static_cast<float>(board.lowest_m);
  record.diodes_high = static_cast<float>(board.highest_m);
  std::ranges::copy(levels.first, record.level_first);
  std::ranges::copy(levels.count, record.level_count);
  record.nearest = static_cast<float>(board.nearest_in_front_m());
  record.line_margin = static_cast<float>(0.5 * line_margin_m(board));
  record.world_rounding = static_cast<float>(world_rounding_m);
  return record;
}

} // namespace

struct SweepPass::State {
  State(const PassSetup &on, const std::vector<SourceWindow> &of_frame,
        const std::optional<ChipGrid> &depth_records)
      : buffers(on.buffers), scene(on.scene), records(depth_records), windows(of_frame),
        lanes(on.device.limits().subgroup),
        specialization{{shader::constant_tiled, is_tiled(on.sensor)},
                       {shader::constant_lanes, lanes},
                       {shader::constant_most_steps, on.device.is_cpu() ? shader::most_sweep_steps : ~0u},
                       {shader::constant_all_facing, on.model.backscatter == shader::backscatter_flat},
                       {shader::constant_depth_records, records.has_value()},
                       {shader::constant_general_chip, records && !records->is_nominal()}},
        of_window(windows.size()) {}

  // A board on the device.
  struct BoardBuffers {
    Buffer items, boxes, planes;
    Buffer hidden_items, hidden_boxes;
    TreeLevels levels, hidden_levels;
    bool any_hidden;
  };

  // A window on the device.
  struct WindowBuffers {
    Buffer record, hidden_record, piercers; // the board's, with the window's piercers
    Buffer ranks, prefixes, lines, diodes;
    vulkan::TexelBuffers texels, hidden_texels;
    std::size_t board;
    bool first_of_board;
    std::uint32_t rank_bins;
    vulkan::ComputePipeline sweep, exact;
  };

  const StripBuffers &buffers;
  const SceneBuffers &scene;
  std::optional<ChipGrid> records; // given where samples are depth records
  std::vector<SourceWindow> windows;
  std::uint32_t lanes;
  vulkan::Specialization specialization;
  std::uint32_t shining = 0;  // diodes of all windows
  std::size_t most_items = 0; // of a board
  std::vector<BoardBuffers> boards;
  std::vector<WindowBuffers> of_window;
  Buffer shafts, work, entries;
  Buffer header_read; // of the work
  vulkan::ComputePipeline find_shafts, count_edges, write_edges, count_hidden, write_hidden;
  std::uint32_t spare_entry = 0;
  bool may_lose = false;

  vulkan::ComputePipeline pipeline(const PassSetup &on, std::string_view name) const;
  void add_board(const PassSetup &on, const Board &board, const SweepItems &items);
  // Adds a window of the board that was added last.
  void add_window(const PassSetup &on, const Board &board, const SweepItems &items,
                  const SourceGroups &groups, std::size_t window);
  void upload_records(const PassSetup &on, const Board &board, const SweepItems &items,
                      const SourceGroups &groups, std::size_t window);
  void make_list_pipelines(const PassSetup &on);
  void make_lists(const PassSetup &on, vk::DeviceSize tiles);

  shader::SweepConstants constants(const shader::Strip &strip, std::size_t window,
                                   std::uint32_t round = 0) const;
  // Resets what is decided, and for a board's first window what is listed, too.
  void record_reset(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    std::size_t window) const;
  // Finds how long the tiles' lists are.
  void record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                    std::size_t window) const;
  void record_read_back(const vk::raii::CommandBuffer &commands) const;
  // Writes a round's lists and decides for its tiles.
  void record_round(const vk::raii::CommandBuffer &commands, const shader::Strip &strip, std::size_t window,
                    std::uint32_t round) const;
};

shader::SweepConstants SweepPass::State::constants(const shader::Strip &strip, std::size_t window,
                                                   std::uint32_t round) const {
  const WindowBuffers &of = of_window[window];
  const shader::Strip of_samples = sample_strip(strip, records.has_value());
  return {of_samples,
          buffers.position.words(),
          buffers.ids.words(),
          scene.planes.words(),
          of.record.words(),
          shafts.words(),
          work.words(),
          entries.words(),
          buffers.visibility.words(),
          boards[of.board].planes.words(),
          round,
          spare_entry,
          tile_count(of_samples),
          sample_count(strip),
          windows[window].bundles * shader::diodes_per_bundle,
          of.rank_bins};
}

void SweepPass::State::record_reset(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                    std::size_t window) const {
  vulkan::barrier_before_update(commands);
  const vk::DeviceSize word = sizeof(std::uint32_t),
                       tiles = tile_count(sample_strip(strip, records.has_value()));
  commands.fillBuffer(buffers.visibility.get(), 0, windows[window].bundles * word * sample_count(strip), ~0u);
  if (window == 0)
    commands.fillBuffer(buffers.lit.get(), 0, sample_count(strip) * word, shining);
  if (of_window[window].first_of_board) {
    shader::SweepWork nothing{};
    std::ranges::fill(nothing.rounds, shader::SweepRound{0, 1, 1, 0, shader::tile_samples / lanes, 0, 1, 0,
                                                         windows[window].bundles, 0, 1, 0});
    commands.updateBuffer<shader::SweepWork>(work.get(), 0, nothing);
    if (!boards[of_window[window].board].any_hidden)
      commands.fillBuffer(work.get(), sizeof(nothing) + 2 * tiles * word, tiles * word, 0);
  } else {
    for (std::size_t round = 0; round < shader::sweep_rounds; ++round)
      commands.updateBuffer<std::uint32_t>(
          work.get(), round * sizeof(shader::SweepRound) + offsetof(shader::SweepRound, sample_groups_x),
          std::array<std::uint32_t, 4>{windows[window].bundles, 0, 1, 0});
  }
  vulkan::barrier_after_update(commands);
}

void SweepPass::State::record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                    std::size_t window) const {
  const WindowBuffers &of = of_window[window];
  const shader::SweepConstants plain = constants(strip, window);
  find_shafts.dispatch(commands, plain, padded(plain.tiles), shader::workgroup_size, &of.texels);
  vulkan::compute_barrier(commands);
  // Tiles four beside each other; some groups at the strip's rims are not full.
  const std::uint32_t high = lanes / 4;
  const shader::Strip &cut = plain.strip;
  const std::uint32_t groups = ((tiles_across(cut.columns) + 3) / 4) *
                               ((tiles_across(cut.rows) + high - 1) / high) * cut.samples * cut.samples;
  if (boards[of.board].any_hidden) {
    shader::SweepConstants hidden = plain;
    hidden.board = of.hidden_record.words();
    count_hidden.dispatch(commands, hidden, groups * lanes, lanes, &of.hidden_texels);
    vulkan::compute_barrier(commands);
  }
  count_edges.dispatch(commands, plain, groups * lanes, lanes, &of.texels);
  vulkan::compute_barrier(commands);
}

void SweepPass::State::record_round(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                    std::size_t window, std::uint32_t round) const {
  const WindowBuffers &of = of_window[window];
  const shader::SweepConstants plain = constants(strip, window, round);
  const vk::DeviceSize begin = round * sizeof(shader::SweepRound);
  const vk::DeviceSize list_groups = begin + offsetof(shader::SweepRound, list_groups_x);
  if (boards[of.board].any_hidden) {
    shader::SweepConstants hidden = plain;
    hidden.board = of.hidden_record.words();
    write_hidden.dispatch_indirect(commands, hidden, work, list_groups, &of.hidden_texels);
  }
  write_edges.dispatch_indirect(commands, plain, work, list_groups, &of.texels);
  vulkan::compute_barrier(commands);
  of.sweep.dispatch_indirect(commands, plain, work, begin + offsetof(shader::SweepRound, tile_groups_x),
                             &of.texels);
  vulkan::compute_barrier(commands);
  of.exact.dispatch_indirect(commands, plain, work, begin + offsetof(shader::SweepRound, sample_groups_x),
                             &of.texels);
  vulkan::compute_barrier(commands);
}

SweepPass::~SweepPass() = default;

vulkan::ComputePipeline SweepPass::State::pipeline(const PassSetup &on, std::string_view name) const {
  return {on.device,
          vulkan::shader_module(on.device, on.options.precision, name),
          sizeof(shader::SweepConstants),
          specialization,
          {texel_buffers, lanes}};
}

void SweepPass::State::add_board(const PassSetup &on, const Board &board, const SweepItems &items) {
  const vulkan::Device &device = on.device;
  const SweepTree edges = sweep_tree(items.edges), hidden = sweep_tree(items.hidden);
  most_items = std::max(most_items, edges.items.size() + hidden.items.size());
  std::vector<shader::SweepPlanes> planes = items.planes;
  planes.resize(edges.items.size());
  boards.push_back({vulkan::upload_texels(device, edges.items), vulkan::upload_texels(device, edges.boxes),
                    vulkan::upload(device, planes), vulkan::upload_texels(device, hidden.items),
                    vulkan::upload_texels(device, hidden.boxes), edges.levels, hidden.levels,
                    !items.hidden.empty()});
  specialization.set(shader::constant_lens_apart, std::abs(board.lens_z_m) > 1e-9);
}

void SweepPass::State::upload_records(const PassSetup &on, const Board &board, const SweepItems &items,
                                      const SourceGroups &groups, std::size_t window) {
  WindowBuffers &of = of_window[window];
  const std::vector<shader::Piercer> piercers =
      find_piercers(board, items.in_the_way, places_of(windows[window], groups));
  of.piercers = vulkan::upload(on.device, piercers.empty() ? std::vector<shader::Piercer>(1) : piercers);
  const std::vector<std::uint32_t> bits = diodes_of(windows[window], groups).bits;
  const auto record_of = [&](const TreeLevels &levels) {
    shader::SweepBoard record = board_record(board, items, levels, on.scene.world_rounding_m);
    if (records) {
      record.slope = records->slope();
      record.chip = records->chip();
    }
    for (std::size_t bundle = 0; bundle < bits.size(); ++bundle)
      record.shining[bundle / 4][static_cast<glm::length_t>(bundle % 4)] = bits[bundle];
    record.leaves_none = !items.in_the_way.empty();
    record.lit = on.buffers.lit.words();
    record.piercers = of.piercers.words();
    record.piercer_count = static_cast<std::uint32_t>(piercers.size());
    return vulkan::upload(on.device, std::as_bytes(std::span(&record, 1)));
  };
  of.record = record_of(boards.back().levels);
  of.hidden_record = record_of(boards.back().hidden_levels);
  for (const std::uint32_t of_bundle : bits)
    shining += static_cast<std::uint32_t>(std::popcount(of_bundle));
}

void SweepPass::State::add_window(const PassSetup &on, const Board &board, const SweepItems &items,
                                  const SourceGroups &groups, std::size_t window) {
  upload_records(on, board, items, groups, window);
  const vulkan::Device &device = on.device;
  const SweepTables tables = sweep_tables(board, places_of(windows[window], groups));
  WindowBuffers &of = of_window[window];
  of.ranks = vulkan::upload_texels(device, tables.ranks);
  of.prefixes = vulkan::upload_texels(device, tables.prefixes);
  of.lines = vulkan::upload_texels(device, tables.lines);
  of.diodes = vulkan::upload_texels(device, tables.diodes);
  of.rank_bins = static_cast<std::uint32_t>(tables.ranks.size());
  of.board = boards.size() - 1;
  of.first_of_board = window == 0 || !std::ranges::binary_search(board.windows, window - 1);
  const BoardBuffers &of_board = boards.back();
  constexpr vk::Format words = vk::Format::eR32G32B32A32Uint, floats = vk::Format::eR32G32B32A32Sfloat;
  const auto bind = [&](const Buffer &items_, const Buffer &boxes) {
    return vulkan::TexelBuffers(device, {{items_, words},
                                         {boxes, floats},
                                         {of.ranks, words},
                                         {of.prefixes, words},
                                         {of.lines, words},
                                         {of.diodes, floats},
                                         {of_board.hidden_items, words}});
  };
  of.texels = bind(of_board.items, of_board.boxes);
  of.hidden_texels = bind(of_board.hidden_items, of_board.hidden_boxes);
  specialization.set(shader::constant_bundles, windows[window].bundles)
      .set(shader::constant_exact_only, !board.is_flat || !items.in_the_way.empty() || !tables.tells_angles);
  of.sweep = pipeline(on, "sweep");
  of.exact = pipeline(on, "sweep_exact");
}

void SweepPass::State::make_list_pipelines(const PassSetup &on) {
  find_shafts = pipeline(on, "sweep_shafts");
  const auto lists = [&](bool is_first, bool hidden) {
    specialization.set(shader::constant_is_first, is_first).set(shader::constant_lists_hidden, hidden);
    return pipeline(on, "sweep_lists");
  };
  count_edges = lists(true, false);
  write_edges = lists(false, false);
  count_hidden = lists(true, true);
  write_hidden = lists(false, true);
}

void SweepPass::State::make_lists(const PassSetup &on, vk::DeviceSize tiles) {
  using Usage = vk::BufferUsageFlagBits;
  shafts = sweep_storage(on.device, tiles * sizeof(shader::TileShaft));
  const vk::DeviceSize words = (4 + shader::sweep_rounds + shader::tile_samples) * tiles;
  work = sweep_storage(on.device, sizeof(shader::SweepWork) + words * sizeof(std::uint32_t),
                       Usage::eIndirectBuffer | Usage::eTransferDst | Usage::eTransferSrc);
  may_lose = (on.device.is_cpu() && most_items > fewest_to_lose) ||
             most_items * tiles > std::uint64_t{shader::sweep_rounds} * shader::entries_per_round;
  spare_entry = static_cast<std::uint32_t>(shader::entries_per_round + most_items);
  entries = sweep_storage(on.device, (vk::DeviceSize{spare_entry} + 1) * sizeof(std::uint32_t));
  header_read = Buffer(on.device, sizeof(shader::SweepWork), Usage::eTransferDst, vulkan::Memory::read);
}

SweepPass::SweepPass(const PassSetup &on, const Occluders &occluders, const CameraScene &camera,
                     const Scene &scene, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                     std::span<const PlannedStrip> strips, const std::optional<ChipGrid> &records)
    : state_(std::make_unique<State>(on, windows, records)) {
  for (const Board &board : find_boards(groups, windows)) {
    const SweepItems items = sweep_items(board, occluders, camera, scene);
    state_->add_board(on, board, items);
    for (const std::size_t window : board.windows)
      state_->add_window(on, board, items, groups, window);
  }
  state_->make_list_pipelines(on);
  state_->make_lists(on, largest_tile_count(strips));
}

void SweepPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                       std::size_t window) const {
  const State &state = *state_;
  const State::WindowBuffers &of = state.of_window[window];
  state.record_reset(commands, strip, window);
  if (of.first_of_board)
    state.record_count(commands, strip, window);
  for (std::uint32_t round = 0; round < shader::sweep_rounds; ++round)
    state.record_round(commands, strip, window, round);
  state.record_read_back(commands);
}

void SweepPass::State::record_read_back(const vk::raii::CommandBuffer &commands) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  vulkan::memory_barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite, Stage::eTransfer,
                         Access::eTransferRead);
  commands.copyBuffer(work.get(), header_read.get(), vk::BufferCopy(0, 0, sizeof(shader::SweepWork)));
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eHost, Access::eHostRead);
}

bool SweepPass::may_lose() const { return state_->may_lose; }

bool SweepPass::has_lost() const {
  shader::SweepWork work;
  std::memcpy(&work, state_->header_read.mapped().data(), sizeof(work));
  return work.lost != 0;
}

} // namespace pmdsim
