#include "engine/passes/lit.h"

#include "engine/passes/occluder_tree.h"
#include "engine/passes/sample_precision.h"
#include "engine/vulkan/commands.h"
#include "spirv/lit_count.h"
#include "spirv/lit_gather_double_float.h"
#include "spirv/lit_gather_fp64.h"
#include "spirv/lit_open_double_float.h"
#include "spirv/lit_open_fp64.h"
#include "spirv/lit_tiles.h"
#include "spirv/lit_trace_double_float.h"
#include "spirv/lit_trace_fp64.h"
#include "spirv/lit_try_double_float.h"
#include "spirv/lit_try_fp64.h"

#include <algorithm>

namespace pmdsim {
namespace {

constexpr std::uint32_t parts_per_tile = 2;
constexpr std::uint32_t lists = 1 + 3 * shader::bundles_per_window; // of parts, in LitWork
constexpr std::uint32_t most_slots = 1u << 16;                      // for candidates; further ones trace rays

std::uint32_t in_tiles(std::uint32_t pixels) { return (pixels + shader::tile_side - 1) / shader::tile_side; }

std::uint32_t tiles_of(const shader::Strip &strip) {
  return in_tiles(strip.columns) * in_tiles(strip.rows) * strip.samples * strip.samples;
}

std::uint32_t parts_of(const shader::Strip &strip) { return parts_per_tile * tiles_of(strip); }

std::uint32_t most_parts(std::span<const PlannedStrip> strips) {
  std::uint32_t most = 0;
  for (const PlannedStrip &planned : strips)
    most = std::max(most, parts_of(planned.strip));
  return most;
}

vulkan::Buffer storage(const vulkan::Device &device, vk::DeviceSize bytes, vk::BufferUsageFlags more = {}) {
  return {device, bytes, vk::BufferUsageFlagBits::eStorageBuffer | more, vulkan::Memory::device};
}

// Nothing to do yet.
shader::LitWork no_work(std::uint32_t bundles) {
  shader::LitWork work{};
  work.open = {0, bundles, 1, 0};
  std::ranges::fill(work.tried, shader::Dispatch{0, 1, 1, 0});
  std::ranges::fill(work.traced, shader::Dispatch{0, shader::diodes_per_bundle, 1, 0});
  std::ranges::fill(work.walked, shader::Dispatch{0, shader::diodes_per_bundle, 1, 0});
  return work;
}

} // namespace

LitPass::LitPass(const vulkan::Device &device, const Occluders &occluders, const DiodeGroups &groups,
                 const std::vector<LitWindow> &windows, const SceneBuffers &scene,
                 std::span<const PlannedStrip> strips, bool tiled, SamplePrecision precision)
    : windows_(windows), slots_(std::min(most_slots, most_parts(strips) * shader::bundles_per_window)),
      bodies_(vulkan::upload(device, std::as_bytes(std::span(occluders.bodies)))) {
  const OccluderTree tree = build_tree(occluders.shapes);
  nodes_ = static_cast<std::uint32_t>(tree.nodes.size());
  occluders_ = vulkan::upload(device, std::as_bytes(std::span(tree.occluders)));
  tree_ = vulkan::upload(device, std::as_bytes(std::span(tree.nodes)));
  using Usage = vk::BufferUsageFlagBits;
  for (const LitWindow &window : windows_) {
    const WindowDiodes diodes = diodes_of(window, groups);
    diodes_.push_back({vulkan::upload(device, std::as_bytes(std::span(diodes.boxes))),
                       vulkan::upload(device, std::as_bytes(std::span(diodes.bundles))),
                       vulkan::upload(device, std::as_bytes(std::span(diodes.bits)))});
    count_.emplace_back(device, shader::lit_count_spirv,
                        static_cast<std::uint32_t>(sizeof(shader::LitCountConstants)),
                        vulkan::Specialization{window.bundles, count_.empty() ? 1u : 0u});
  }
  const shader::LitScene record{words(scene.planes.address()),
                                words(occluders_.address()),
                                words(tree_.address()),
                                words(bodies_.address()),
                                words(scene.paint.shapes.address()),
                                words(scene.paint.surfaces.address()),
                                nodes_,
                                static_cast<float>(scene.world_rounding_m)};
  scene_ = vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
  const vk::DeviceSize parts = most_parts(strips);
  parts_ = storage(device, parts * sizeof(shader::TilePart));
  work_ = storage(device, sizeof(shader::LitWork) + lists * parts * sizeof(std::uint32_t),
                  Usage::eIndirectBuffer | Usage::eTransferDst);
  candidates_ =
      storage(device, vk::DeviceSize{slots_} * (shader::largest_candidates + 1) * sizeof(std::uint32_t));

  const bool masked =
      std::ranges::any_of(tree.occluders, [](const auto &occluder) { return occluder.may_be_absent != 0; });
  const auto pipeline = [&](std::span<const std::uint32_t> fp64, std::span<const std::uint32_t> double_float,
                            std::size_t constants, bool again = false) {
    return vulkan::ComputePipeline(device, choose(device, precision, fp64, double_float),
                                   static_cast<std::uint32_t>(constants),
                                   {tiled ? 1u : 0u, masked ? 1u : 0u, again ? 1u : 0u});
  };
  tiles_ = pipeline(shader::lit_tiles_spirv, shader::lit_tiles_spirv, sizeof(shader::LitTilesConstants));
  open_ = pipeline(shader::lit_open_fp64_spirv, shader::lit_open_double_float_spirv,
                   sizeof(shader::LitGatherConstants));
  gather_ = pipeline(shader::lit_gather_fp64_spirv, shader::lit_gather_double_float_spirv,
                     sizeof(shader::LitGatherConstants));
  try_ = pipeline(shader::lit_try_fp64_spirv, shader::lit_try_double_float_spirv,
                  sizeof(shader::LitDecideConstants));
  trace_ = pipeline(shader::lit_trace_fp64_spirv, shader::lit_trace_double_float_spirv,
                    sizeof(shader::LitDecideConstants));
  walk_ = pipeline(shader::lit_trace_fp64_spirv, shader::lit_trace_double_float_spirv,
                   sizeof(shader::LitDecideConstants), true);
}

void LitPass::record_tiles(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                           const StripBuffers &buffers) const {
  vulkan::compute_barrier(commands);
  const shader::LitTilesConstants constants{strip, words(buffers.position_hi.address()),
                                            words(buffers.tags.address()), words(scene_.address()),
                                            words(parts_.address())};
  tiles_.dispatch(commands, constants, padded(tiles_of(strip)), shader::workgroup_size);
}

void LitPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                     const StripBuffers &buffers, std::size_t window) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  // Whoever used what is overwritten here is done.
  vulkan::memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect, Access::eShaderStorageWrite,
                         Stage::eTransfer, Access::eTransferWrite);
  const vk::DeviceSize words_bytes =
      vk::DeviceSize{windows_[window].bundles} * sample_count(strip) * sizeof(std::uint32_t);
  commands.fillBuffer(buffers.reached.get(), 0, words_bytes, ~0u);
  const shader::LitWork work = no_work(windows_[window].bundles);
  commands.updateBuffer<shader::LitWork>(work_.get(), 0, work);
  vulkan::memory_barrier(commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader,
                         Access::eShaderStorageRead | Access::eShaderStorageWrite);
  record_gather(commands, strip, buffers, window);
  record_decide(commands, strip, buffers, window);
  record_count(commands, strip, buffers, window);
}

void LitPass::record_gather(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                            const StripBuffers &buffers, std::size_t window) const {
  const std::uint32_t parts = parts_of(strip);
  const shader::LitGatherConstants constants{strip,
                                             words(buffers.position_hi.address()),
                                             words(buffers.tags.address()),
                                             words(parts_.address()),
                                             words(scene_.address()),
                                             words(diodes_[window].boxes.address()),
                                             words(work_.address()),
                                             words(candidates_.address()),
                                             parts,
                                             windows_[window].bundles,
                                             slots_};
  open_.dispatch(commands, constants, padded(parts), shader::workgroup_size);
  vulkan::compute_barrier(commands);
  gather_.dispatch_indirect(commands, constants, work_, offsetof(shader::LitWork, open));
}

void LitPass::record_decide(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                            const StripBuffers &buffers, std::size_t window) const {
  for (std::uint32_t bundle = 0; bundle < windows_[window].bundles; ++bundle) {
    vulkan::compute_barrier(commands);
    shader::LitDecideConstants constants{
        strip,
        words(buffers.position_hi.address()),
        words(buffers.position_lo.address()),
        words(buffers.tags.address()),
        words(parts_.address()),
        words(scene_.address()),
        words(diodes_[window].bundles.address() + bundle * sizeof(shader::BundleDiodes)),
        words(work_.address()),
        words(candidates_.address()),
        words(buffers.reached.address() +
              vk::DeviceSize{bundle} * sample_count(strip) * sizeof(std::uint32_t)),
        bundle,
        windows_[window].bundles,
        parts_of(strip),
        0,
        nodes_};
    const auto at = [bundle](std::size_t list) { return list + bundle * sizeof(shader::Dispatch); };
    try_.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, tried)));
    trace_.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, traced)));
    if (nodes_ <= shader::steps_per_walk)
      continue;
    vulkan::compute_barrier(commands);
    for (std::uint32_t first = 0; first < nodes_; first += shader::steps_per_walk) {
      constants.first_node = first;
      constants.last_node = std::min(nodes_, first + shader::steps_per_walk);
      walk_.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, walked)));
    }
  }
}

void LitPass::record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                           const StripBuffers &buffers, std::size_t window) const {
  vulkan::compute_barrier(commands);
  const std::uint32_t plane = sample_count(strip);
  const shader::LitCountConstants constants{words(buffers.reached.address()),
                                            words(diodes_[window].bits.address()),
                                            words(buffers.lit.address()), plane};
  count_[window].dispatch(commands, constants, plane, shader::workgroup_size);
}

} // namespace pmdsim
