#include "engine/passes/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>

namespace pmdsim {
namespace {

constexpr double grid = 256.0; // steps of the raster's grid a sample: Vulkan's usual sub-pixel precision
constexpr double margin_samples = 16; // kept around a block, so that clipped edges' snapping stays outside it
constexpr double nearest_depth_m = 1e-7;
constexpr std::size_t boxes_at_most = 1024;

// Samples (x, y) = scale * (X, Y) / Z + centre, counted from the frame's top left.
struct Optics {
  glm::dvec2 scale;
  glm::dvec2 centre;
};

Optics optics_of(const Sensor &sensor) {
  const double samples = sensor.samples;
  return {samples * sensor.image_distance_m() / sensor.pixel_pitch_m,
          0.5 * samples * glm::dvec2(sensor.resolution)};
}

// The half-space normal . P >= offset.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;

  double height(const glm::dvec3 &p) const { return glm::dot(normal, p) - offset; }
};

using Frustum = std::array<HalfSpace, 5>;
using Polygon = std::vector<glm::dvec3>;

// In front of the lens, and between the block's borders widened by the margin.
Frustum frustum_of(const Optics &optics, const glm::dvec2 &first_sample, const glm::dvec2 &last_sample) {
  const glm::dvec2 low = optics.centre - first_sample + margin_samples;
  const glm::dvec2 high = last_sample + margin_samples - optics.centre;
  return {{{{0, 0, 1}, nearest_depth_m},
           {{optics.scale.x, 0, low.x}, 0},
           {{-optics.scale.x, 0, high.x}, 0},
           {{0, optics.scale.y, low.y}, 0},
           {{0, -optics.scale.y, high.y}, 0}}};
}

bool comes_before(const glm::dvec3 &a, const glm::dvec3 &b) {
  return std::lexicographical_compare(&a.x, &a.x + 3, &b.x, &b.x + 3);
}

// Where the edge crosses the half-space's border; the same bits whichever way round the edge is walked, so
// that neighbours that share it stay watertight.
glm::dvec3 crossing(const HalfSpace &half_space, glm::dvec3 a, glm::dvec3 b) {
  if (comes_before(b, a))
    std::swap(a, b);
  const double height_a = half_space.height(a), height_b = half_space.height(b);
  return a + (b - a) * (height_a / (height_a - height_b));
}

// Sutherland and Hodgman's clipping of a convex polygon.
void clip(Polygon &polygon, Polygon &scratch, const HalfSpace &half_space) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const bool from_inside = half_space.height(from) >= 0.0, to_inside = half_space.height(to) >= 0.0;
    if (from_inside)
      scratch.push_back(from);
    if (from_inside != to_inside)
      scratch.push_back(crossing(half_space, from, to));
  }
  std::swap(polygon, scratch);
}

// Boxes around what is visible of consecutive triangles; how many share one follows from how many there are.
class BoxBuilder {
public:
  explicit BoxBuilder(std::size_t triangles)
      : triangles_per_box_(triangles / boxes_at_most + 1),
        boxes_(triangles / triangles_per_box_ + 1, {glm::dvec3(infinity), glm::dvec3(-infinity)}) {}

  void add(std::size_t triangle, const Polygon &polygon) {
    VisibleBox &box = boxes_[triangle / triangles_per_box_];
    for (const glm::dvec3 &p : polygon) {
      box.low_m = glm::min(box.low_m, p);
      box.high_m = glm::max(box.high_m, p);
    }
  }

  std::vector<VisibleBox> take() {
    std::erase_if(boxes_, [](const VisibleBox &box) { return box.low_m.x > box.high_m.x; });
    return std::move(boxes_);
  }

private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  std::size_t triangles_per_box_;
  std::vector<VisibleBox> boxes_; // low above high: nothing visible
};

shader::RasterVertex raster_vertex(const glm::dvec3 &p, const Optics &optics, const glm::dvec2 &first_sample,
                                   std::uint32_t triangle) {
  const glm::dvec2 sample = optics.scale * glm::dvec2(p) / p.z + optics.centre;
  const glm::dvec2 snapped = glm::roundEven(sample * grid) / grid - first_sample;
  return {static_cast<float>(snapped.x), static_cast<float>(snapped.y), static_cast<float>(0.5 / p.z),
          triangle};
}

void project_block(const CameraScene &camera, const Optics &optics, std::uint32_t samples, RasterBlock &block,
                   Projection &projection, BoxBuilder &boxes) {
  const glm::dvec2 first_sample = glm::dvec2(block.first_pixel * samples);
  const Frustum frustum =
      frustum_of(optics, first_sample, glm::dvec2((block.first_pixel + block.pixels) * samples));
  Polygon polygon, scratch;
  block.first_vertex = static_cast<std::uint32_t>(projection.vertices.size());
  for (std::size_t i = 0; i < camera.triangles.size(); ++i) {
    const CameraTriangle &triangle = camera.triangles[i];
    polygon.assign(triangle.corners_m.begin(), triangle.corners_m.end());
    for (std::size_t side = 0; side < frustum.size() && !polygon.empty(); ++side)
      clip(polygon, scratch, frustum[side]);
    if (polygon.size() < 3)
      continue;
    boxes.add(i, polygon);
    const auto vertex = [&](std::size_t k) {
      return raster_vertex(polygon[k], optics, first_sample, triangle.id);
    };
    for (std::size_t k = 2; k < polygon.size(); ++k)
      projection.vertices.insert(projection.vertices.end(), {vertex(0), vertex(k - 1), vertex(k)});
  }
  block.vertex_count = static_cast<std::uint32_t>(projection.vertices.size()) - block.first_vertex;
}

// Into blocks as even as can be: a strip's image is as wide as the widest and as high as the highest of them.
std::vector<RasterBlock> cut_into_blocks(const Sensor &sensor, std::uint32_t block_samples) {
  const glm::uvec2 largest(block_samples / sensor.samples);
  const glm::uvec2 counts = (sensor.resolution + largest - 1u) / largest;
  const glm::uvec2 size = (sensor.resolution + counts - 1u) / counts;
  std::vector<RasterBlock> blocks;
  for (std::uint32_t row = 0; row < sensor.resolution.y; row += size.y)
    for (std::uint32_t column = 0; column < sensor.resolution.x; column += size.x) {
      const glm::uvec2 first(column, row);
      blocks.push_back({first, glm::min(size, sensor.resolution - first), 0, 0});
    }
  return blocks;
}

// From 0.5 / depth to 0.5 * nearest / depth, which fills the depth buffer's range.
void scale_depths(Projection &projection) {
  float largest = 0.0f;
  for (const shader::RasterVertex &vertex : projection.vertices)
    largest = std::max(largest, vertex.inverse_depth);
  for (shader::RasterVertex &vertex : projection.vertices)
    vertex.inverse_depth *= 0.5f / largest;
}

} // namespace

Projection project(const CameraScene &camera, const Sensor &sensor, std::uint32_t block_samples) {
  const Optics optics = optics_of(sensor);
  Projection projection;
  projection.blocks = cut_into_blocks(sensor, block_samples);
  BoxBuilder boxes(camera.triangles.size());
  for (RasterBlock &block : projection.blocks)
    project_block(camera, optics, sensor.samples, block, projection, boxes);
  scale_depths(projection);
  projection.visible = boxes.take();
  return projection;
}

} // namespace pmdsim
