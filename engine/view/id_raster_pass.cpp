#include "engine/view/id_raster_pass.h"

#include "engine/vulkan/commands.h"
#include "engine/vulkan/errors.h"
#include "engine/vulkan/float_pair.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

namespace pmdsim {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

constexpr auto id_format = vk::Format::eR32G32Uint;
constexpr auto record_format = vk::Format::eR32G32B32A32Uint;
constexpr auto stages_with_constants = vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

vk::Extent2D extent_of(const PlannedStrip &planned, const std::vector<RasterBlock> &blocks) {
  const glm::uvec2 fragments = strip_fragments(planned.strip, blocks[planned.block]);
  return {fragments.x, fragments.y};
}

std::vector<vk::Extent2D> extents_of(const std::vector<PlannedStrip> &strips,
                                     const std::vector<RasterBlock> &blocks) {
  std::vector<vk::Extent2D> extents(strips.size());
  std::ranges::transform(strips, extents.begin(),
                         [&](const PlannedStrip &planned) { return extent_of(planned, blocks); });
  return extents;
}

// Rays of the blocks' fragments, for shaders that have to know them.
vulkan::Buffer upload_planes(const vulkan::Device &device, const std::vector<RasterBlock> &blocks) {
  std::vector<shader::BlockPlane> records;
  for (const RasterBlock &block : blocks) {
    const glm::dmat3 camera_from_raster = glm::inverse(block.raster_from_camera);
    const DoublePair4 x(camera_from_raster[0], 0.0), y(camera_from_raster[1], 0.0),
        corner(camera_from_raster[2], 0.0);
    records.push_back({x.hi, x.lo, y.hi, y.lo, corner.hi, corner.lo});
  }
  return vulkan::upload(device, std::as_bytes(std::span(records)));
}

// The shaders of a raster with the values of their constants, and what it draws on.
struct Raster {
  const vulkan::ShaderModule &vertex, &fragment;
  vulkan::Specialization of_vertex, of_fragment;
  vk::Format format;
};

vulkan::Pipeline make_pipeline(const vulkan::Device &device, const Raster &raster) {
  return vulkan::checked([&] {
    const vk::PushConstantRange range(stages_with_constants, 0, sizeof(shader::IdRasterConstants));
    vk::raii::PipelineLayout layout(device.get(), vk::PipelineLayoutCreateInfo({}, {}, range));
    using ShaderBit = vk::ShaderStageFlagBits;
    const vulkan::ShaderStage vertex(device, ShaderBit::eVertex, raster.vertex, raster.of_vertex);
    const vulkan::ShaderStage fragment(device, ShaderBit::eFragment, raster.fragment, raster.of_fragment);
    const std::array stages{vertex.info(), fragment.info()};
    const vk::VertexInputBindingDescription binding(0, sizeof(shader::RasterVertex));
    const std::array attributes{
        vk::VertexInputAttributeDescription(0, 0, vk::Format::eR32G32B32Sfloat,
                                            offsetof(shader::RasterVertex, x_fragments)),
        vk::VertexInputAttributeDescription(1, 0, vk::Format::eR32Uint,
                                            offsetof(shader::RasterVertex, triangle))};
    const vk::PipelineVertexInputStateCreateInfo input({}, binding, attributes);
    const vk::PipelineInputAssemblyStateCreateInfo assembly({}, vk::PrimitiveTopology::eTriangleList);
    const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
    vk::PipelineRasterizationStateCreateInfo filled;
    filled.setCullMode(vk::CullModeFlagBits::eNone).setLineWidth(1.0f);
    const vk::PipelineMultisampleStateCreateInfo multisample({}, vk::SampleCountFlagBits::e1);
    // At the same depth, the triangle that comes first in the scene stays.
    const vk::PipelineDepthStencilStateCreateInfo depth({}, true, true, vk::CompareOp::eGreater);
    vk::PipelineColorBlendAttachmentState write;
    using Component = vk::ColorComponentFlagBits;
    write.setColorWriteMask(Component::eR | Component::eG | Component::eB | Component::eA);
    const vk::PipelineColorBlendStateCreateInfo blend({}, false, vk::LogicOp::eCopy, write);
    const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic_state({}, dynamic);
    const vk::PipelineRenderingCreateInfo rendering(0, raster.format, RasterImages::depth_format);
    const vk::GraphicsPipelineCreateInfo info({}, stages, &input, &assembly, nullptr, &viewport, &filled,
                                              &multisample, &depth, &blend, &dynamic_state, *layout, {}, 0,
                                              {}, 0, &rendering);
    vk::raii::Pipeline pipeline(device.get(), nullptr, info);
    return vulkan::Pipeline{std::move(layout), std::move(pipeline)};
  });
}

// A device has one viewport, and each fragment shader one vertex shader.
std::shared_ptr<const vulkan::Pipeline> compiled(const vulkan::Device &device, const Raster &raster) {
  return device.pipelines().get({raster.fragment.spirv.data(), raster.of_fragment, raster.format},
                                [&] { return make_pipeline(device, raster); });
}

// A triangle's vertices take some 30 times as long to fetch its plane, for its fragments, as a sample takes
// to.
bool vertices_fetch_planes(const Projection &projection, const Sensor &sensor) {
  constexpr std::size_t samples_per_triangle = 32;
  const std::size_t triangles = projection.vertices.size() / 3;
  return samples_per_triangle * triangles <= sensor.pixel_count() * sensor.samples * sensor.samples;
}

} // namespace

std::uint32_t raster_block_fragments(const vulkan::Device &device) {
  return std::min(std::bit_floor(device.limits().viewport_samples) / 2, device.limits().raster_samples);
}

IdRasterPass::IdRasterPass(const vulkan::Device &device, const Projection &projection, const Sensor &sensor,
                           const std::vector<PlannedStrip> &strips, const SceneBuffers &scene,
                           SamplePrecision precision, const std::optional<ChipGrid> &grid,
                           const vulkan::Buffer &id_buffer, std::optional<RasterImages> &&previous)
    : sensor_(sensor), scene_(scene), id_buffer_(id_buffer), blocks_(projection.blocks),
      vertices_(vulkan::upload(device, std::as_bytes(std::span(projection.vertices)),
                               vk::BufferUsageFlagBits::eVertexBuffer)),
      planes_of_blocks_(scene.paint.cutouts ? upload_planes(device, projection.blocks) : vulkan::Buffer()),
      grid_(grid),
      half_viewport_(0.5f * static_cast<float>(std::bit_floor(device.limits().viewport_samples))) {
  const bool by_fragments = grid && vertices_fetch_planes(projection, sensor);
  const vulkan::Specialization constants{
      {shader::constant_half_viewport, std::bit_cast<std::uint32_t>(half_viewport_)},
      {shader::constant_general_chip, grid && !grid->is_nominal()},
      {shader::constant_cutouts, scene.paint.cutouts}};
  const vulkan::ShaderModule &vertex =
      vulkan::shader_module(device, precision, by_fragments ? "id_raster_depth_vert" : "id_raster_vert");
  const vulkan::ShaderModule &fragment =
      vulkan::shader_module(device, precision, by_fragments ? "id_raster_depth_frag" : "id_raster_frag");
  compiled_ =
      compiled(device, {vertex, fragment, vulkan::declared_part(vertex, constants),
                        vulkan::declared_part(fragment, constants), grid ? record_format : id_format});
  if (grid && !by_fragments)
    depths_.emplace(device, vulkan::shader_module(device, precision, "record_depths"),
                    sizeof(shader::RecordDepthsConstants), constants);
  images_.emplace(device, extents_of(strips, projection.blocks), grid ? record_format : id_format, id_buffer,
                  std::move(previous));
}

std::optional<RasterImages> IdRasterPass::release_images() {
  if (images_)
    images_->leave_buffer();
  return std::exchange(images_, std::nullopt);
}

void IdRasterPass::record(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const {
  const vk::Extent2D extent = extent_of(planned, blocks_);
  images_->begin(commands, extent);
  draw(commands, planned);
  images_->end(commands, extent);
  if (depths_)
    add_depths(commands, planned);
}

void IdRasterPass::add_depths(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const {
  const vk::Extent2D extent = extent_of(planned, blocks_);
  const std::uint32_t fragments = extent.width * extent.height;
  const shader::RecordDepthsConstants constants{
      grid_->of(planned.strip), grid_->chip(), scene_.planes.words(), id_buffer_.words(), fragments, 0};
  depths_->dispatch(commands, constants, padded(fragments), shader::workgroup_size);
  vulkan::memory_barrier(commands, Stage::eComputeShader, Access::eShaderStorageWrite,
                         Stage::eComputeShader | Stage::eTransfer,
                         Access::eShaderStorageRead | Access::eShaderStorageWrite | Access::eTransferRead);
}

void IdRasterPass::draw(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned) const {
  const RasterBlock &block = blocks_[planned.block];
  if (block.vertex_count == 0)
    return;
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *compiled_->pipeline);
  commands.bindVertexBuffers(0, vertices_.get(), {vk::DeviceSize{0}});
  const std::uint32_t tiles = is_tiled(sensor_) ? planned.strip.samples : 1;
  for (std::uint32_t row = 0; row < tiles; ++row)
    for (std::uint32_t column = 0; column < tiles; ++column)
      draw_tile(commands, planned, {column, row});
}

void IdRasterPass::draw_tile(const vk::raii::CommandBuffer &commands, const PlannedStrip &planned,
                             const glm::uvec2 &tile) const {
  const shader::Strip &strip = planned.strip;
  const RasterBlock &block = blocks_[planned.block];
  const bool tiled = is_tiled(sensor_);
  const std::uint32_t side = tiled ? 1 : strip.samples; // fragments along a pixel, but for distortion
  const glm::uvec2 size = strip_fragments(strip, block) / (tiled ? strip.samples : 1u);
  const glm::uvec2 in_block =
      block.distorted ? glm::uvec2(0) : (glm::uvec2(strip.column, strip.row) - block.first_pixel) * side;
  const glm::uvec2 corner = tile * size;
  // The block's fragment 0 lies a quarter into the viewport; the viewport moves so that the strip starts at
  // the tile's corner. All of these are whole numbers that float holds.
  const glm::vec2 origin = glm::vec2(-0.5f * half_viewport_) - glm::vec2(in_block) + glm::vec2(corner);
  commands.setViewport(0,
                       vk::Viewport(origin.x, origin.y, 2 * half_viewport_, 2 * half_viewport_, 0.0f, 1.0f));
  commands.setScissor(0,
                      vk::Rect2D({static_cast<std::int32_t>(corner.x), static_cast<std::int32_t>(corner.y)},
                                 {size.x, size.y}));
  const shader::SampleGrid grid = grid_ ? grid_->of(strip) : shader::SampleGrid{};
  const shader::IdRasterConstants constants{
      raster_shift(sensor_, tile),
      corner.x,
      corner.y,
      strip.column,
      strip.row,
      strip.resolution_x,
      block.distorted ? 0 : side,
      sample_shift(sensor_, tile),
      in_block.x,
      in_block.y,
      planes_of_blocks_.words(planned.block * sizeof(shader::BlockPlane)),
      scene_.planes.words(),
      scene_.paint.shapes.words(),
      scene_.paint.surfaces.words(),
      grid.slope,
      grid.first,
      grid_ ? grid_->chip() : shader::uvec2(0)};
  commands.pushConstants<shader::IdRasterConstants>(*compiled_->layout, stages_with_constants, 0, constants);
  commands.draw(block.vertex_count, 1, block.first_vertex, 0);
}

} // namespace pmdsim
