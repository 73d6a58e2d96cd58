#include "engine/shadow/tile_shadow_pass.h"

#include "engine/shadow/occluders.h"
#include "engine/vulkan/commands.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <string_view>

namespace pmdsim {
namespace {

// For the candidates of so many parts there is memory; further ones, in frames of many samples a pixel, trace
// rays.
constexpr std::uint32_t most_slots = 1u << 16;

std::uint32_t in_tiles(std::uint32_t pixels) { return (pixels + shader::tile_side - 1) / shader::tile_side; }

std::uint32_t tiles_of(const shader::Strip &strip) {
  return in_tiles(strip.columns) * in_tiles(strip.rows) * strip.samples * strip.samples;
}

std::uint32_t parts_of(const shader::Strip &strip) { return shader::parts_per_tile * tiles_of(strip); }

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
shader::LitWork no_work() {
  shader::LitWork work{};
  std::ranges::fill(work.list, shader::Dispatch{0, 1, 1, 0});
  // Rays: along y the diodes.
  std::fill(work.list + shader::list_unclear, work.list + shader::lists,
            shader::Dispatch{0, shader::diodes_per_bundle, 1, 0});
  return work;
}

vk::DeviceSize arguments_of(std::uint32_t list) {
  return offsetof(shader::LitWork, list) + list * sizeof(shader::Dispatch);
}

bool may_have_holes(const Occluders &occluders) {
  return std::ranges::any_of(occluders.shapes,
                             [](const shader::Occluder &occluder) { return occluder.may_be_absent != 0; });
}

bool are_flat(const std::vector<WindowDiodes> &windows) {
  return std::ranges::all_of(windows, [](const WindowDiodes &diodes) {
    return std::ranges::all_of(diodes.bundles, [](const shader::BundleDiodes &bundle) {
      return std::ranges::all_of(bundle.places, [](const shader::vec4 &place) { return place.z == 0.0f; });
    });
  });
}

LitScene upload_scene(const vulkan::Device &device, const Occluders &occluders, const SceneBuffers &scene) {
  const OccluderTree tree = build_tree(occluders.shapes);
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size());
  LitScene lit{nodes,
               vulkan::upload(device, std::as_bytes(std::span(tree.occluders))),
               vulkan::upload(device, std::as_bytes(std::span(tree.nodes))),
               vulkan::upload(device, std::as_bytes(std::span(occluders.bodies))),
               {}};
  const shader::LitScene record{scene.planes.words(),
                                lit.occluders.words(),
                                lit.tree.words(),
                                lit.bodies.words(),
                                scene.paint.shapes.words(),
                                scene.paint.surfaces.words(),
                                nodes,
                                static_cast<float>(scene.world_rounding_m)};
  lit.record = vulkan::upload(device, std::as_bytes(std::span(&record, 1)));
  return lit;
}

LitDiodes upload_diodes(const vulkan::Device &device, const WindowDiodes &diodes) {
  return {vulkan::upload(device, std::as_bytes(std::span(diodes.boxes))),
          vulkan::upload(device, std::as_bytes(std::span(diodes.bundles))),
          vulkan::upload(device, std::as_bytes(std::span(diodes.bits)))};
}

// What is compiled in or out.
struct LitForm {
  bool tiled;   // the IDs lie in tiles (shaders/shared/interface.h)
  bool cutouts; // occluders may have holes
  bool flat;    // within a bundle all diodes have the same z
};

// Invocations that try a part's candidates: on a CPU as few as its vectors have lanes, so that what one of
// them loads serves many samples; on a GPU one for each sample.
std::uint32_t lanes_to_try(const vulkan::Device &device) {
  return device.is_cpu() ? 8 : shader::tile_samples;
}

LitPipelines make_lit_pipelines(const vulkan::Device &device, const std::vector<SourceWindow> &windows,
                                const LitForm &form, SamplePrecision precision) {
  vulkan::Specialization constants{{shader::constant_tiled, form.tiled},
                                   {shader::constant_cutouts, form.cutouts},
                                   {shader::constant_flat_bundles, form.flat},
                                   {shader::constant_lanes, lanes_to_try(device)},
                                   {shader::constant_is_first, 1}};
  const auto pipeline = [&](std::string_view name, std::size_t push_constant_bytes) {
    return vulkan::ComputePipeline(device, vulkan::shader_module(device, precision, name),
                                   push_constant_bytes, constants);
  };
  LitPipelines made;
  made.tiles = pipeline("lit_tiles", sizeof(shader::LitTilesConstants));
  made.open = pipeline("lit_open", sizeof(shader::LitGatherConstants));
  made.gather = pipeline("lit_gather", sizeof(shader::LitGatherConstants));
  made.attempt = pipeline("lit_try", sizeof(shader::LitDecideConstants));
  made.clear = pipeline("lit_clear", sizeof(shader::LitDecideConstants));
  made.trace = pipeline("lit_trace", sizeof(shader::LitDecideConstants));
  for (const SourceWindow &window : windows) {
    constants.set(shader::constant_bundles, window.bundles)
        .set(shader::constant_is_first, made.counts.empty());
    made.counts.push_back(pipeline("lit_count", sizeof(shader::LitCountConstants)));
  }
  constants.set(shader::constant_is_first, 0);
  made.walk = pipeline("lit_trace", sizeof(shader::LitDecideConstants));
  return made;
}

} // namespace

TileShadowPass::TileShadowPass(const vulkan::Device &device, const Occluders &occluders,
                               const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                               const SceneBuffers &scene, std::span<const PlannedStrip> strips, bool tiled,
                               SamplePrecision precision)
    : windows_(windows), slots_(std::min(most_slots, most_parts(strips))),
      scene_(upload_scene(device, occluders, scene)),
      parts_(storage(device, most_parts(strips) * sizeof(shader::TilePart))),
      work_(storage(device,
                    sizeof(shader::LitWork) +
                        vk::DeviceSize{shader::lists} * most_parts(strips) * sizeof(std::uint32_t),
                    vk::BufferUsageFlagBits::eIndirectBuffer | vk::BufferUsageFlagBits::eTransferDst)),
      candidates_(storage(device, vk::DeviceSize{slots_} * shader::candidate_words * sizeof(std::uint32_t))) {
  std::vector<WindowDiodes> diodes;
  for (const SourceWindow &window : windows_)
    diodes.push_back(diodes_of(window, groups));
  for (const WindowDiodes &of_window : diodes)
    diodes_.push_back(upload_diodes(device, of_window));
  pipelines_ =
      make_lit_pipelines(device, windows_, {tiled, may_have_holes(occluders), are_flat(diodes)}, precision);
}

void TileShadowPass::record_tiles(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                  const StripBuffers &buffers) const {
  const shader::LitTilesConstants constants{strip, buffers.position.words(), buffers.ids.words(),
                                            scene_.record.words(), parts_.words()};
  pipelines_.tiles.dispatch(commands, constants, padded(tiles_of(strip)), shader::workgroup_size);
}

void TileShadowPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                            const StripBuffers &buffers, std::size_t window) const {
  using Stage = vk::PipelineStageFlagBits2;
  using Access = vk::AccessFlagBits2;
  // Whoever used what is overwritten here is done.
  vulkan::memory_barrier(commands, Stage::eComputeShader | Stage::eDrawIndirect | Stage::eTransfer,
                         Access::eShaderStorageWrite, Stage::eTransfer, Access::eTransferWrite);
  const vk::DeviceSize words_bytes =
      vk::DeviceSize{windows_[window].bundles} * sample_count(strip) * sizeof(std::uint32_t);
  commands.fillBuffer(buffers.visibility.get(), 0, words_bytes, ~0u);
  const shader::LitWork work = no_work();
  commands.updateBuffer<shader::LitWork>(work_.get(), 0, work);
  const vk::DeviceSize list_bytes = vk::DeviceSize{parts_of(strip)} * sizeof(std::uint32_t);
  commands.fillBuffer(work_.get(), sizeof(work) + shader::list_said * list_bytes, list_bytes, 0);
  vulkan::memory_barrier(
      commands, Stage::eTransfer, Access::eTransferWrite, Stage::eComputeShader | Stage::eDrawIndirect,
      Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eIndirectCommandRead);
  shader::LitGatherConstants constants = gather_constants(strip, buffers, window);
  pipelines_.open.dispatch(commands, constants, padded(constants.part_count), shader::workgroup_size);
  for (std::uint32_t bundle = 0; bundle < windows_[window].bundles; ++bundle) {
    vulkan::compute_barrier(commands);
    constants.bundle = bundle;
    pipelines_.gather.dispatch_indirect(commands, constants, work_, arguments_of(shader::list_open));
    vulkan::compute_barrier(commands);
    record_decide(commands, strip, buffers, window, bundle);
  }
  record_count(commands, strip, buffers, window);
}

shader::LitGatherConstants TileShadowPass::gather_constants(const shader::Strip &strip,
                                                            const StripBuffers &buffers,
                                                            std::size_t window) const {
  return {strip,
          buffers.position.words(),
          buffers.ids.words(),
          parts_.words(),
          scene_.record.words(),
          diodes_[window].boxes.words(),
          work_.words(),
          candidates_.words(),
          parts_of(strip),
          0,
          slots_};
}

void TileShadowPass::record_decide(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                   const StripBuffers &buffers, std::size_t window,
                                   std::uint32_t bundle) const {
  shader::LitDecideConstants constants{
      strip,
      buffers.position.words(),
      buffers.ids.words(),
      parts_.words(),
      scene_.record.words(),
      diodes_[window].bundles.words(bundle * sizeof(shader::BundleDiodes)),
      work_.words(),
      candidates_.words(),
      buffers.visibility.words(vk::DeviceSize{bundle} * sample_count(strip) * sizeof(std::uint32_t)),
      bundle,
      parts_of(strip),
      slots_,
      0,
      0};
  pipelines_.attempt.dispatch_indirect(commands, constants, work_, arguments_of(shader::list_tried + bundle));
  pipelines_.clear.dispatch_indirect(commands, constants, work_, arguments_of(shader::list_traced + bundle));
  vulkan::compute_barrier(commands);
  pipelines_.trace.dispatch_indirect(commands, constants, work_, arguments_of(shader::list_unclear + bundle));
  vulkan::compute_barrier(commands);
  for (std::uint32_t first = 0; first < scene_.nodes; first += shader::steps_per_walk) {
    constants.first_node = first;
    constants.last_node = std::min(scene_.nodes, first + shader::steps_per_walk);
    pipelines_.walk.dispatch_indirect(commands, constants, work_, arguments_of(shader::list_walked + bundle));
  }
}

void TileShadowPass::record_count(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                                  const StripBuffers &buffers, std::size_t window) const {
  vulkan::compute_barrier(commands);
  const std::uint32_t plane = sample_count(strip);
  const shader::LitCountConstants constants{buffers.visibility.words(), diodes_[window].bits.words(),
                                            buffers.lit.words(), plane};
  pipelines_.counts[window].dispatch(commands, constants, plane, shader::workgroup_size);
}

} // namespace pmdsim
