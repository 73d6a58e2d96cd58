#include "engine/passes/lit.h"

#include "engine/passes/occluder_tree.h"
#include "engine/vulkan/commands.h"

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

bool may_have_holes(const Occluders &occluders) {
  return std::ranges::any_of(occluders.shapes,
                             [](const shader::Occluder &occluder) { return occluder.may_be_absent != 0; });
}

LitScene upload_scene(const vulkan::Device &device, const Occluders &occluders, const SceneBuffers &scene) {
  const OccluderTree tree = build_tree(occluders.shapes);
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size());
  LitScene lit{nodes,
               vulkan::upload(device, std::as_bytes(std::span(tree.occluders))),
               vulkan::upload(device, std::as_bytes(std::span(tree.nodes))),
               vulkan::upload(device, std::as_bytes(std::span(occluders.bodies))),
               {}};
  const shader::LitScene record{words(scene.planes.address()),
                                words(lit.occluders.address()),
                                words(lit.tree.address()),
                                words(lit.bodies.address()),
                                words(scene.paint.shapes.address()),
                                words(scene.paint.surfaces.address()),
                                nodes,
                                static_cast<float>(scene.world_rounding_m)};
  lit.record = vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
  return lit;
}

LitDiodes upload_diodes(const vulkan::Device &device, const LitWindow &window, const DiodeGroups &groups) {
  const WindowDiodes diodes = diodes_of(window, groups);
  return {vulkan::upload(device, std::as_bytes(std::span(diodes.boxes))),
          vulkan::upload(device, std::as_bytes(std::span(diodes.bundles))),
          vulkan::upload(device, std::as_bytes(std::span(diodes.bits)))};
}

} // namespace

LitPass::LitPass(const vulkan::Device &device, const Occluders &occluders, const DiodeGroups &groups,
                 const std::vector<LitWindow> &windows, const SceneBuffers &scene,
                 std::span<const PlannedStrip> strips, bool tiled, SamplePrecision precision)
    : windows_(windows), slots_(std::min(most_slots, most_parts(strips) * shader::bundles_per_window)),
      scene_(upload_scene(device, occluders, scene)),
      parts_(storage(device, most_parts(strips) * sizeof(shader::TilePart))),
      work_(storage(device,
                    sizeof(shader::LitWork) +
                        vk::DeviceSize{lists} * most_parts(strips) * sizeof(std::uint32_t),
                    vk::BufferUsageFlagBits::eIndirectBuffer | vk::BufferUsageFlagBits::eTransferDst)),
      candidates_(
          storage(device, vk::DeviceSize{slots_} * (shader::largest_candidates + 1) * sizeof(std::uint32_t))),
      pipelines_(make_lit_pipelines(device, windows, tiled, may_have_holes(occluders), precision)) {
  for (const LitWindow &window : windows_)
    diodes_.push_back(upload_diodes(device, window, groups));
}

void LitPass::record_tiles(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                           const StripBuffers &buffers) const {
  vulkan::compute_barrier(commands);
  const shader::LitTilesConstants constants{strip, words(buffers.position_hi.address()),
                                            words(buffers.tags.address()), words(scene_.record.address()),
                                            words(parts_.address())};
  pipelines_.tiles.dispatch(commands, constants, padded(tiles_of(strip)), shader::workgroup_size);
}

void LitPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                     const StripBuffers &buffers, std::size_t window) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  // Whoever used what is overwritten here is done.
  vulkan::memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect | Stage::eTransfer,
                         Access::eShaderStorageWrite, Stage::eTransfer, Access::eTransferWrite);
  const vk::DeviceSize words_bytes =
      vk::DeviceSize{windows_[window].bundles} * sample_count(strip) * sizeof(std::uint32_t);
  commands.fillBuffer(buffers.reached.get(), 0, words_bytes, ~0u);
  const shader::LitWork work = no_work(windows_[window].bundles);
  commands.updateBuffer<shader::LitWork>(work_.get(), 0, work);
  vulkan::memory_barrier(
      commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader | Stage::eDrawIndirect,
      Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eIndirectCommandRead);
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
                                             words(scene_.record.address()),
                                             words(diodes_[window].boxes.address()),
                                             words(work_.address()),
                                             words(candidates_.address()),
                                             parts,
                                             windows_[window].bundles,
                                             slots_};
  pipelines_.open.dispatch(commands, constants, padded(parts), shader::workgroup_size);
  vulkan::compute_barrier(commands);
  pipelines_.gather.dispatch_indirect(commands, constants, work_, offsetof(shader::LitWork, open));
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
        words(scene_.record.address()),
        words(diodes_[window].bundles.address() + bundle * sizeof(shader::BundleDiodes)),
        words(work_.address()),
        words(candidates_.address()),
        words(buffers.reached.address() +
              vk::DeviceSize{bundle} * sample_count(strip) * sizeof(std::uint32_t)),
        bundle,
        windows_[window].bundles,
        parts_of(strip),
        0,
        scene_.nodes};
    const auto at = [bundle](std::size_t list) { return list + bundle * sizeof(shader::Dispatch); };
    pipelines_.attempt.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, tried)));
    pipelines_.trace.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, traced)));
    if (scene_.nodes <= shader::steps_per_walk)
      continue;
    vulkan::compute_barrier(commands);
    for (std::uint32_t first = 0; first < scene_.nodes; first += shader::steps_per_walk) {
      constants.first_node = first;
      constants.last_node = std::min(scene_.nodes, first + shader::steps_per_walk);
      pipelines_.walk.dispatch_indirect(commands, constants, work_, at(offsetof(shader::LitWork, walked)));
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
  pipelines_.counts[window].dispatch(commands, constants, plane, shader::workgroup_size);
}

} // namespace pmdsim
