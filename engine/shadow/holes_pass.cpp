#include "engine/shadow/holes_pass.h"

#include "engine/shadow/place_order.h"
#include "engine/shadow/tiles.h"
#include "engine/vulkan/commands.h"
#include "engine/vulkan/compute_pipeline.h"
#include "engine/vulkan/texel_buffers.h"
#include "shaders/shadow/holes_interface.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace pmdsim {
namespace {

constexpr std::uint32_t hole_texel_buffers = 3; // of holes.glsl

using HoleBox = std::array<glm::vec4, 2>; // low and high

// Around the corners rounded to float.
HoleBox box_around(const shader::Occluder &shape) {
  const glm::vec4 &a = shape.a_hi, &b = shape.b_hi, &c = shape.c_hi;
  const glm::vec4 rounding = 0x1p-23f * glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
  return {glm::min(a, glm::min(b, c)) - rounding, glm::max(a, glm::max(b, c)) + rounding};
}

// Around each `count` boxes that follow each other.
std::vector<HoleBox> boxes_around(std::span<const HoleBox> boxes, std::size_t count) {
  std::vector<HoleBox> around;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (i % count == 0)
      around.push_back(boxes[i]);
    else
      around.back() = {glm::min(around.back()[0], boxes[i][0]), glm::max(around.back()[1], boxes[i][1])};
  return around;
}

std::vector<shader::Occluder> ordered_by_place(const std::vector<shader::Occluder> &shapes) {
  std::vector<glm::dvec3> middles_m;
  for (const shader::Occluder &shape : shapes)
    middles_m.emplace_back((shape.a_hi + shape.b_hi + shape.c_hi) / 3.0f);
  std::vector<shader::Occluder> ordered;
  for (const std::uint32_t i : order_by_place(middles_m))
    ordered.push_back(shapes[i]);
  return ordered;
}

// The boxes over the shapes, level by level.
struct HoleBoxes {
  std::vector<HoleBox> all;
  std::uint32_t first_block, first_range, ranges;
};

HoleBoxes boxes_over(const std::vector<shader::Occluder> &shapes) {
  std::vector<HoleBox> of_shapes;
  std::ranges::transform(shapes, std::back_inserter(of_shapes), box_around);
  const std::vector<HoleBox> boxes = boxes_around(of_shapes, shader::hole_width),
                             blocks = boxes_around(boxes, shader::hole_width),
                             ranges = boxes_around(blocks, shader::hole_blocks);
  HoleBoxes made{boxes, static_cast<std::uint32_t>(boxes.size()),
                 static_cast<std::uint32_t>(boxes.size() + blocks.size()),
                 static_cast<std::uint32_t>(ranges.size())};
  made.all.insert(made.all.end(), blocks.begin(), blocks.end());
  made.all.insert(made.all.end(), ranges.begin(), ranges.end());
  return made;
}

} // namespace

struct HolesPass::State {
  State(const PassSetup &on, const std::optional<ChipGrid> &grid)
      : buffers(on.buffers), records(grid), lanes(on.device.limits().subgroup),
        specialization{{shader::constant_tiled, is_tiled(on.sensor)},
                       {shader::constant_lanes, lanes},
                       {shader::constant_depth_records, records.has_value()},
                       {shader::constant_general_chip, records && !records->is_nominal()}} {}

  // A window's diodes on the device.
  struct Window {
    vulkan::Buffer record, bundles, places;
    vulkan::TexelBuffers texels;
    vulkan::ComputePipeline holes;
  };

  const StripBuffers &buffers;
  std::optional<ChipGrid> records; // given where samples are depth records
  std::uint32_t lanes;
  vulkan::Specialization specialization;
  shader::HolesWindow record{}; // of no window yet
  std::uint32_t ranges = 0;
  vulkan::Buffer shapes, shape_boxes;
  vulkan::Buffer tile_boxes, work;
  vulkan::ComputePipeline find_tiles, list_tiles;
  std::vector<Window> windows;

  vulkan::ComputePipeline pipeline(const PassSetup &on, std::string_view name,
                                   std::uint32_t subgroup = 0) const;
  void upload_shapes(const PassSetup &on, const std::vector<shader::Occluder> &unordered);
  void make_lists(const PassSetup &on, vk::DeviceSize tiles);
  void add_window(const PassSetup &on, const SourceWindow &window, const SourceGroups &groups);
  shader::HolesConstants constants(const shader::Strip &strip, std::size_t window) const;
  // The ranges from `plain.first_range` on that have lists at a time.
  void record_batch(const vk::raii::CommandBuffer &commands, const shader::HolesConstants &plain,
                    std::size_t window) const;
};

vulkan::ComputePipeline HolesPass::State::pipeline(const PassSetup &on, std::string_view name,
                                                   std::uint32_t subgroup) const {
  return {on.device,
          vulkan::shader_module(on.device, on.options.precision, name),
          sizeof(shader::HolesConstants),
          specialization,
          {hole_texel_buffers, subgroup}};
}

void HolesPass::State::upload_shapes(const PassSetup &on, const std::vector<shader::Occluder> &unordered) {
  const std::vector<shader::Occluder> ordered = ordered_by_place(unordered);
  const HoleBoxes boxes = boxes_over(ordered);
  ranges = boxes.ranges;
  shapes = vulkan::upload_texels(on.device, ordered);
  shape_boxes = vulkan::upload_texels(on.device, boxes.all);
  record.paints = on.scene.paint.shapes.words();
  record.surfaces = on.scene.paint.surfaces.words();
  record.shapes = static_cast<std::uint32_t>(ordered.size());
  record.first_block = boxes.first_block;
  record.first_range = boxes.first_range;
  record.world_rounding = static_cast<float>(on.scene.world_rounding_m);
  if (records) {
    record.slope = records->slope();
    record.chip = records->chip();
  }
}

void HolesPass::State::make_lists(const PassSetup &on, vk::DeviceSize tiles) {
  using Usage = vk::BufferUsageFlagBits;
  tile_boxes = {on.device, tiles * sizeof(shader::TileBox), Usage::eStorageBuffer, vulkan::Memory::device};
  const vk::DeviceSize lists = shader::hole_batch * tiles * sizeof(std::uint32_t);
  work = {on.device, sizeof(shader::HolesWork) + lists,
          Usage::eStorageBuffer | Usage::eIndirectBuffer | Usage::eTransferDst, vulkan::Memory::device};
  find_tiles = pipeline(on, "holes_tiles");
  list_tiles = pipeline(on, "holes_lists");
}

void HolesPass::State::add_window(const PassSetup &on, const SourceWindow &window,
                                  const SourceGroups &groups) {
  const WindowDiodes diodes = diodes_of(window, groups);
  std::vector<shader::vec4> places;
  for (const shader::BundleDiodes &bundle : diodes.bundles)
    places.insert(places.end(), std::begin(bundle.places), std::end(bundle.places));
  Window &made = windows.emplace_back();
  made.bundles = vulkan::upload(on.device, diodes.bundles);
  made.places = vulkan::upload_texels(on.device, places);
  shader::HolesWindow of_window = record;
  of_window.box = diodes.box;
  of_window.bundles = made.bundles.words();
  for (std::size_t bundle = 0; bundle < diodes.bits.size(); ++bundle)
    of_window.shining[bundle / 4][static_cast<glm::length_t>(bundle % 4)] = diodes.bits[bundle];
  made.record = vulkan::upload(on.device, std::as_bytes(std::span(&of_window, 1)));
  constexpr vk::Format words = vk::Format::eR32G32B32A32Uint, floats = vk::Format::eR32G32B32A32Sfloat;
  made.texels =
      vulkan::TexelBuffers(on.device, {{shapes, words}, {shape_boxes, floats}, {made.places, floats}});
  specialization.set(shader::constant_bundles, window.bundles);
  made.holes = pipeline(on, "holes", lanes);
}

HolesPass::HolesPass(const PassSetup &on, const std::vector<shader::Occluder> &shapes,
                     const SourceGroups &groups, const std::vector<SourceWindow> &windows,
                     std::span<const PlannedStrip> strips, const std::optional<ChipGrid> &records)
    : state_(std::make_unique<State>(on, records)) {
  state_->upload_shapes(on, shapes);
  state_->make_lists(on, largest_tile_count(strips));
  for (const SourceWindow &window : windows)
    state_->add_window(on, window, groups);
}

HolesPass::~HolesPass() = default;

shader::HolesConstants HolesPass::State::constants(const shader::Strip &strip, std::size_t window) const {
  const shader::Strip of_samples = sample_strip(strip, records.has_value());
  return {of_samples,
          buffers.position.words(),
          buffers.ids.words(),
          windows[window].record.words(),
          tile_boxes.words(),
          work.words(),
          buffers.visibility.words(),
          buffers.lit.words(),
          0,
          0,
          tile_count(of_samples),
          sample_count(strip)};
}

void HolesPass::State::record_batch(const vk::raii::CommandBuffer &commands,
                                    const shader::HolesConstants &plain, std::size_t window) const {
  vulkan::barrier_before_update(commands);
  shader::HolesWork nothing{};
  std::ranges::fill(nothing.ranges, shader::WorkList{shader::tile_samples, 0, 1, 0});
  commands.updateBuffer<shader::HolesWork>(work.get(), 0, nothing);
  vulkan::barrier_after_update(commands);
  const Window &of = windows[window];
  list_tiles.dispatch(commands, plain, padded(plain.tiles), shader::workgroup_size, &of.texels);
  shader::HolesConstants of_range = plain;
  for (; of_range.range < std::min(shader::hole_batch, ranges - plain.first_range); ++of_range.range) {
    vulkan::compute_barrier(commands);
    of.holes.dispatch_indirect(commands, of_range, work, of_range.range * sizeof(shader::WorkList),
                               &of.texels);
  }
}

void HolesPass::record(const vk::raii::CommandBuffer &commands, const shader::Strip &strip,
                       std::size_t window) const {
  shader::HolesConstants plain = state_->constants(strip, window);
  state_->find_tiles.dispatch(commands, plain, padded(plain.tiles), shader::workgroup_size,
                              &state_->windows[window].texels);
  for (; plain.first_range < state_->ranges; plain.first_range += shader::hole_batch)
    state_->record_batch(commands, plain, window);
}

} // namespace pmdsim
