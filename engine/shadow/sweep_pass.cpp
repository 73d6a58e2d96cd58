#include "engine/shadow/sweep_pass.h"

#include "engine/shadow/sweep_items.h"
#include "engine/shadow/sweep_tables.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/float_pair.h"
#include "engine/vulkan/texel_buffers.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <string_view>

namespace pmdsim {
namespace {

using vulkan::Buffer;

std::uint32_t tiles_across(std::uint32_t pixels) {
  return (pixels + shader::tile_side - 1) / shader::tile_side;
}

std::uint32_t tile_count(const shader::Strip &strip) {
  return tiles_across(strip.columns) * tiles_across(strip.rows) * strip.samples * strip.samples;
}

std::uint32_t largest_tile_count(std::span<const PlannedStrip> strips) {
  std::uint32_t most = 0;
  for (const PlannedStrip &planned : strips)
    most = std::max(most, tile_count(planned.strip));
  return most;
}

// Where a list may begin, below it: beyond it lists of all items have room.
constexpr std::uint32_t list_capacity = 1u << 23;

Buffer sweep_storage(const vulkan::Device &device, vk::DeviceSize bytes, vk::BufferUsageFlags more = {}) {
  return {device, bytes, vk::BufferUsageFlagBits::eStorageBuffer | more, vulkan::Memory::device};
}

template <class T>
Buffer upload_texels(const vulkan::Device &device, const std::vector<T> &texels) {
  return vulkan::upload(device, std::as_bytes(std::span(texels)),
                        vk::BufferUsageFlagBits::eUniformTexelBuffer);
}

shader::SweepBoard board_record(const Board &board, const SweepItems &items, const SweepTree &tree,
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
  std::ranges::copy(tree.level_first, record.level_first);
  std::ranges::copy(tree.level_count, record.level_count);
  record.nearest =
      static_cast<float>(std::min(board.lowest_m, board.lens_z_m) - 0.01 * board.radius_m - 1e-4);
  record.line_margin = static_cast<float>(0.5 * line_margin_m(board));
  record.world_rounding = static_cast<float>(world_rounding_m);
  return record;
}

} // namespace

struct SweepPass::State {
  // A board on the device.
  struct BoardBuffers {
    Buffer items, boxes, planes;
    Buffer hidden_items, hidden_boxes;
    bool any_hidden;
  };

  // A window on the device.
  struct WindowBuffers {
    Buffer record, hidden_record, piercers; // the board's, with the window's piercers
    Buffer ranks, prefixes, lines, diodes, bits;
    vulkan::TexelBuffers texels, hidden_texels;
    std::size_t board;
    bool first_of_board;
    std::uint32_t rank_bins;
    vulkan::ComputePipeline sweep, exact, count;
  };

  std::vector<SourceWindow> windows;
  std::uint32_t lanes;
  std::vector<BoardBuffers> boards;
  std::vector<WindowBuffers> of_window;
  Buffer shafts, work, entries;
  vulkan::ComputePipeline find_shafts, count_lists, write_lists, count_hidden, write_hidden;
  std::uint32_t spare_entry = 0;
  vulkan::Buffer const *planes = nullptr;

  shader::SweepConstants constants(const shader::Strip &strip, const StripBuffers &buffers,
                                   std::size_t window) const {
    const WindowBuffers &of = of_window[window];
    const BoardBuffers &board = boards[of.board];
    return {strip,
            buffers.position.words(),
            buffers.ids.words(),
            planes->words(),
            of.record.words(),
            shafts.words(),
            work.words(),
            entries.words(),
            buffers.visibility.words(),
            board.planes.words(),
            list_capacity,
            spare_entry,
            tile_count(strip),
            sample_count(strip),
            windows[window].bundles * shader::diodes_per_bundle,
            of.rank_bins};
  }
};

SweepPass::~SweepPass() {
  if (getenv("SWEEP_DEBUG") && state_->work.is_mapped()) {
    const auto *w = reinterpret_cast<const shader::SweepWork *>(state_->work.mapped().data());
    fprintf(stderr, "sweep: active tiles %u samples %u entries %u full %u; items %zu hidden %zu\n", w->tiles,
            w->samples, w->entries, w->is_full, state_->boards[0].items.bytes() / 64,
            state_->boards[0].hidden_items.bytes() / 64);
  }
}

SweepPass::SweepPass(const vulkan::Device &device, const Occluders &occluders, const CameraScene &camera,
                     const Scene &scene, const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                     const SceneBuffers &buffers, std::span<const PlannedStrip> strips, bool tiled,
                     bool all_facing, SamplePrecision precision)
    : state_(std::make_unique<State>()) {
  State &state = *state_;
  state.windows = windows;
  state.lanes = device.limits().subgroup;
  state.planes = &buffers.planes;
  const std::vector<Board> boards = find_boards(groups, windows);
  std::size_t most_items = 0;
  state.of_window.resize(windows.size());
  vulkan::Specialization constants{{shader::constant_tiled, tiled},
                                   {shader::constant_lanes, state.lanes},
                                   {shader::constant_all_facing, all_facing}};
  const auto pipeline = [&](std::string_view name, std::size_t bytes, std::uint32_t texel_buffers) {
    return vulkan::ComputePipeline(device, vulkan::shader_module(device, precision, name), bytes, constants,
                                   {texel_buffers, texel_buffers > 0 ? state.lanes : 0});
  };
  constexpr std::uint32_t texel_buffers = 7;
  for (std::size_t b = 0; b < boards.size(); ++b) {
    const Board &board = boards[b];
    const SweepItems items = sweep_items(board, occluders, camera, scene);
    most_items = std::max({most_items, items.edges.items.size(), items.hidden.items.size()});
    state.boards.push_back({upload_texels(device, items.edges.items),
                            upload_texels(device, items.edges.boxes), vulkan::upload(device, items.planes),
                            upload_texels(device, items.hidden.items),
                            upload_texels(device, items.hidden.boxes), items.any_hidden});
    constants.set(shader::constant_lens_apart, std::abs(board.lens_z_m) > 1e-9);
    for (const std::size_t window : board.windows) {
      const SweepTables tables = sweep_tables(board, places_of(windows[window], groups));
      auto &of = state.of_window[window];
      const std::vector<shader::Piercer> piercers =
          find_piercers(board, items.in_the_way, places_of(windows[window], groups));
      of.piercers = vulkan::upload(device, piercers.empty() ? std::vector<shader::Piercer>(1) : piercers);
      const auto record_of = [&](const SweepTree &tree) {
        shader::SweepBoard record = board_record(board, items, tree, buffers.world_rounding_m);
        record.piercers = of.piercers.words();
        record.piercer_count = static_cast<std::uint32_t>(piercers.size());
        return vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
      };
      of.record = record_of(items.edges);
      of.hidden_record = record_of(items.hidden);
      constants.set(shader::constant_exact_only, !board.is_flat || !items.in_the_way.empty());
      of.ranks = upload_texels(device, tables.ranks);
      of.prefixes = upload_texels(device, tables.prefixes);
      of.lines = upload_texels(device, tables.lines);
      of.diodes = upload_texels(device, tables.diodes);
      of.bits = vulkan::upload(device, diodes_of(windows[window], groups).bits);
      of.board = b;
      of.first_of_board = window == board.windows.front();
      of.rank_bins = static_cast<std::uint32_t>(tables.ranks.size());
      constexpr vk::Format words = vk::Format::eR32G32B32A32Uint, floats = vk::Format::eR32G32B32A32Sfloat;
      const auto bind = [&](const Buffer &items_, const Buffer &boxes) {
        return vulkan::TexelBuffers(device, {{items_, words},
                                             {boxes, floats},
                                             {of.ranks, words},
                                             {of.prefixes, words},
                                             {of.lines, words},
                                             {of.diodes, floats},
                                             {state.boards[b].hidden_items, words}});
      };
      of.texels = bind(state.boards[b].items, state.boards[b].boxes);
      of.hidden_texels = bind(state.boards[b].hidden_items, state.boards[b].hidden_boxes);
      constants.set(shader::constant_bundles, windows[window].bundles)
          .set(shader::constant_is_first, window == 0);
      of.sweep = pipeline("sweep", sizeof(shader::SweepConstants), texel_buffers);
      of.exact = pipeline("sweep_exact", sizeof(shader::SweepConstants), texel_buffers);
      of.count = pipeline("lit_count", sizeof(shader::LitCountConstants), 0);
    }
  }
  state.find_shafts = pipeline("sweep_shafts", sizeof(shader::SweepConstants), texel_buffers);
  const auto lists = [&](bool is_first, bool hidden) {
    constants.set(shader::constant_is_first, is_first).set(shader::constant_lists_hidden, hidden);
    return pipeline("sweep_lists", sizeof(shader::SweepConstants), texel_buffers);
  };
  state.count_lists = lists(true, false);
  state.write_lists = lists(false, false);
  state.count_hidden = lists(true, true);
  state.write_hidden = lists(false, true);
  const vk::DeviceSize tiles = largest_tile_count(strips);
  state.shafts = sweep_storage(device, tiles * sizeof(shader::TileShaft));
  state.work = sweep_storage(
      device, sizeof(shader::SweepWork) + (5 + shader::tile_samples) * tiles * sizeof(std::uint32_t),
      vk::BufferUsageFlagBits::eIndirectBuffer | vk::BufferUsageFlagBits::eTransferDst);
  state.spare_entry = static_cast<std::uint32_t>(list_capacity + most_items);
  state.entries = sweep_storage(device, (vk::DeviceSize{state.spare_entry} + 1) * sizeof(std::uint32_t));
}

void SweepPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                       const StripBuffers &buffers, std::size_t window) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  const State &state = *state_;
  const State::WindowBuffers &of = state.of_window[window];
  const State::BoardBuffers &board = state.boards[of.board];
  const shader::SweepConstants constants = state.constants(strip, buffers, window);
  const auto before_transfer = [&] {
    vulkan::memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect | Stage::eTransfer,
                           Access::eShaderStorageWrite, Stage::eTransfer, Access::eTransferWrite);
  };
  const auto after_transfer = [&] {
    vulkan::memory_barrier(
        commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader | Stage::eDrawIndirect,
        Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eIndirectCommandRead);
  };
  const int stop = getenv("STOP") ? atoi(getenv("STOP")) : 9;
  if (stop < 1)
    return;
  before_transfer();
  commands.fillBuffer(buffers.visibility.get(), 0,
                      vk::DeviceSize{state.windows[window].bundles} * constants.plane * sizeof(std::uint32_t),
                      ~0u);
  if (of.first_of_board) {
    shader::SweepWork nothing{};
    nothing.tile_groups_x = shader::tile_samples / state.lanes;
    nothing.sample_groups_x = 1;
    nothing.tile_groups_z = nothing.sample_groups_z = 1;
    commands.updateBuffer<shader::SweepWork>(state.work.get(), 0, nothing);
    if (!board.any_hidden)
      commands.fillBuffer(state.work.get(),
                          sizeof(nothing) + 2 * vk::DeviceSize{constants.tiles} * sizeof(std::uint32_t),
                          vk::DeviceSize{constants.tiles} * sizeof(std::uint32_t), 0);
  } else {
    const std::array<std::uint32_t, 4> no_samples{1, 0, 1, 0};
    commands.updateBuffer<std::uint32_t>(state.work.get(), offsetof(shader::SweepWork, sample_groups_x),
                                         no_samples);
  }
  after_transfer();
  if (stop < 2)
    return;
  if (of.first_of_board) {
    state.find_shafts.dispatch(commands, constants, padded(constants.tiles), shader::workgroup_size,
                               &of.texels);
    vulkan::compute_barrier(commands);
    if (stop < 3)
      return;
    // Tiles four beside each other; some groups at the strip's rims are not full.
    const std::uint32_t high = state.lanes / 4;
    const std::uint32_t groups = ((tiles_across(strip.columns) + 3) / 4) *
                                 ((tiles_across(strip.rows) + high - 1) / high) * strip.samples *
                                 strip.samples;
    const auto list = [&](const vulkan::ComputePipeline &how, bool hidden) {
      shader::SweepConstants of_kind = constants;
      if (hidden)
        of_kind.board = of.hidden_record.words();
      how.dispatch(commands, of_kind, groups * state.lanes, state.lanes,
                   hidden ? &of.hidden_texels : &of.texels);
      vulkan::compute_barrier(commands);
    };
    if (board.any_hidden) {
      list(state.count_hidden, true);
      list(state.write_hidden, true);
    }
    list(state.count_lists, false);
    list(state.write_lists, false);
  }
  if (stop < 4)
    return;
  of.sweep.dispatch_indirect(commands, constants, state.work, offsetof(shader::SweepWork, tile_groups_x),
                             &of.texels);
  vulkan::compute_barrier(commands);
  if (stop < 5)
    return;
  of.exact.dispatch_indirect(commands, constants, state.work, offsetof(shader::SweepWork, sample_groups_x),
                             &of.texels);
  vulkan::compute_barrier(commands);
  if (stop < 6)
    return;
  const shader::LitCountConstants count{buffers.visibility.words(), of.bits.words(), buffers.lit.words(),
                                        constants.plane};
  of.count.dispatch(commands, count, constants.plane, shader::workgroup_size);
}

} // namespace pmdsim
