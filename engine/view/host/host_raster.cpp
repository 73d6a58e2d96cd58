#include "engine/view/host/host_raster.h"

#include "engine/model/instruction_sets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

PMDSIM_LOOPS_OF_EACH_SET(pmdsim::RasterKernel, raster_kernel)

namespace pmdsim {

namespace {

constexpr std::uint32_t band_rows = 32;     // whose depths and ids stay in a processor's own cache
constexpr std::uint32_t spare_columns = 16; // as many as the widest vectors have lanes

// The fragments whose middles lie within a triangle's bounds, both ends included.
struct Bounds {
  glm::ivec2 low, high;

  bool is_empty() const { return low.x > high.x || low.y > high.y; }
};

Bounds bounds_of(const BlockTriangle &triangle, const glm::uvec2 &fragments) {
  const auto [low_x, high_x] = std::minmax({triangle.x[0], triangle.x[1], triangle.x[2]});
  const auto [low_y, high_y] = std::minmax({triangle.y[0], triangle.y[1], triangle.y[2]});
  const glm::vec2 low = glm::ceil(glm::vec2(low_x, low_y) - 0.5f),
                  high = glm::floor(glm::vec2(high_x, high_y) - 0.5f);
  return {glm::max(glm::ivec2(low), glm::ivec2(0)), glm::min(glm::ivec2(high), glm::ivec2(fragments) - 1)};
}

// Whether one of a few fragments has its middle in the triangle or on its border; exact, as corners lie on
// the raster's grid and near the fragments.
bool covers_any(const BlockTriangle &triangle, const Bounds &bounds) {
  const auto side = [&](std::size_t from, std::size_t to, float x, float y) {
    return (triangle.y[to] - triangle.y[from]) * (x - triangle.x[from]) -
           (triangle.x[to] - triangle.x[from]) * (y - triangle.y[from]);
  };
  for (int row = bounds.low.y; row <= bounds.high.y; ++row)
    for (int column = bounds.low.x; column <= bounds.high.x; ++column) {
      const float x = static_cast<float>(column) + 0.5f, y = static_cast<float>(row) + 0.5f;
      const float ab = side(0, 1, x, y), bc = side(1, 2, x, y), ca = side(2, 0, x, y);
      if ((ab >= 0.0f && bc >= 0.0f && ca >= 0.0f) || (ab <= 0.0f && bc <= 0.0f && ca <= 0.0f))
        return true;
    }
  return false;
}

bool is_seen(const BlockTriangle &triangle, const Bounds &bounds) {
  constexpr int few = 4; // fragments along either axis, so that floats hold the products
  return !bounds.is_empty() && (bounds.high.x - bounds.low.x >= few || bounds.high.y - bounds.low.y >= few ||
                                covers_any(triangle, bounds));
}

BlockTriangle triangle_at(const shader::RasterVertex *corners) {
  BlockTriangle triangle{};
  for (std::size_t k = 0; k < 3; ++k) {
    triangle.x[k] = corners[k].x_fragments;
    triangle.y[k] = corners[k].y_fragments;
    triangle.inverse_depth[k] = corners[k].inverse_depth;
  }
  triangle.id = corners->triangle;
  return triangle;
}

} // namespace

HostRaster::Block HostRaster::block_of(const Projection &projection, const RasterBlock &of) {
  Block block;
  block.first_pixel = of.first_pixel;
  std::vector<Bounds> bounds;
  block.begin_of_band.resize((of.fragments.y + band_rows - 1) / band_rows + 1);
  for (std::uint32_t i = 0; i < of.vertex_count; i += 3) {
    const BlockTriangle triangle = triangle_at(&projection.vertices[of.first_vertex + i]);
    const Bounds within = bounds_of(triangle, of.fragments);
    if (!is_seen(triangle, within))
      continue;
    block.triangles.push_back(triangle);
    bounds.push_back(within);
    for (std::uint32_t band = static_cast<std::uint32_t>(within.low.y) / band_rows;
         band <= static_cast<std::uint32_t>(within.high.y) / band_rows; ++band)
      ++block.begin_of_band[band + 1];
  }
  for (std::size_t band = 1; band < block.begin_of_band.size(); ++band)
    block.begin_of_band[band] += block.begin_of_band[band - 1];
  block.listed.resize(block.begin_of_band.back());
  std::vector<std::size_t> next = block.begin_of_band;
  for (std::uint32_t i = 0; i < bounds.size(); ++i)
    for (std::uint32_t band = static_cast<std::uint32_t>(bounds[i].low.y) / band_rows;
         band <= static_cast<std::uint32_t>(bounds[i].high.y) / band_rows; ++band)
      block.listed[next[band]++] = i;
  return block;
}

HostRaster::HostRaster(const Projection &projection, const Sensor &sensor, const CameraScene &camera,
                       const Scene &scene, const SceneBuffers &on_device, const std::optional<ChipGrid> &grid,
                       const vulkan::Buffer &id_buffer, std::uint32_t most_bits)
    : edges_(find_edge_samples(camera, scene, sensor, projection.blocks)), scene_(on_device), grid_(grid),
      id_buffer_(id_buffer), samples_(sensor.samples), kernel_(&widest_raster_kernel(most_bits)) {
  if (!id_buffer.is_mapped() || !on_device.planes.is_mapped())
    throw std::logic_error("the host does not share the device's memory");
  for (const RasterBlock &block : projection.blocks)
    blocks_.push_back(block_of(projection, block));
  std::ranges::fill(id_buffer.mapped(), std::byte{}); // what a warm-up reads
}

// Puts right what the raster's grid may have decided the wrong way.
void HostRaster::settle(const PlannedStrip &planned, const BandRows &band) const {
  const std::uint32_t first_row = planned.strip.row * samples_ + band.first, end_row = first_row + band.rows,
                      first_column = planned.strip.column * samples_;
  const std::size_t begin = planned.block == 0 ? 0 : edges_.end_of_block[planned.block - 1];
  const std::span<const shader::EdgeSample> of_block(
      edges_.samples.begin() + static_cast<std::ptrdiff_t>(begin),
      edges_.samples.begin() + edges_.end_of_block[planned.block]);
  const auto pixel_row = [this](const shader::EdgeSample &edge) { return edge.row / samples_; };
  for (auto edge = std::ranges::lower_bound(of_block, first_row / samples_, {}, pixel_row);
       edge != of_block.end() && edge->row / samples_ <= (end_row - 1) / samples_; ++edge)
    if (edge->row >= first_row && edge->row < end_row)
      band.ids[std::size_t{edge->row - first_row} * band.stride + edge->column - first_column] =
          edge->triangle;
}

void HostRaster::draw_band(const PlannedStrip &planned, const BandSamples &to, std::uint32_t number) const {
  const Block &block = blocks_[planned.block];
  const shader::Strip &strip = planned.strip;
  const glm::uvec2 in_block = (glm::uvec2(strip.column, strip.row) - block.first_pixel) * samples_;
  const std::uint32_t begin = std::max(number * band_rows, in_block.y),
                      end = std::min((number + 1) * band_rows, in_block.y + strip.rows * samples_);
  BandRows band{};
  band.column = in_block.x;
  band.row = in_block.y;
  band.first = begin - in_block.y;
  band.rows = end - begin;
  band.columns = strip.columns * samples_;
  band.stride = band.columns + spare_columns;
  thread_local std::vector<float> depths;
  thread_local std::vector<std::uint32_t> ids;
  depths.assign(std::size_t{band.stride} * band.rows, 0.0f);
  ids.assign(std::size_t{band.stride} * band.rows, shader::no_triangle);
  band.depths = depths.data();
  band.ids = ids.data();
  kernel_->draw(band, block.triangles.data(), block.listed.data() + block.begin_of_band[number],
                block.begin_of_band[number + 1] - block.begin_of_band[number]);
  settle(planned, band);
  kernel_->leave(band, to);
}

void HostRaster::draw(const PlannedStrip &planned) const {
  const shader::Strip &strip = planned.strip;
  BandSamples to{};
  to.strip = strip;
  to.planes = scene_.planes.mapped_as<shader::TrianglePlane>();
  to.samples = id_buffer_.mapped().data();
  to.records = grid_.has_value();
  if (grid_) {
    const shader::SampleGrid grid = grid_->of(strip);
    to.chip = grid_->is_nominal() ? nullptr : &grid_->place();
    to.slope[0] = static_cast<double>(grid.slope.x) + static_cast<double>(grid.slope.y);
    to.slope[1] = static_cast<double>(grid.slope.z) + static_cast<double>(grid.slope.w);
    to.first[0] = grid.first.x;
    to.first[1] = grid.first.y;
  }
  const std::uint32_t first_row = (strip.row - blocks_[planned.block].first_pixel.y) * samples_;
  tbb::parallel_for(first_row / band_rows, (first_row + strip.rows * samples_ - 1) / band_rows + 1,
                    [&](std::uint32_t band) { draw_band(planned, to, band); });
}

} // namespace pmdsim
