#include "engine/view/projection.h"

#include "engine/view/mesh_edges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pmdsim {
namespace {

constexpr double grid = 256.0; // steps of the raster's grid a fragment: Vulkan's usual sub-pixel precision
constexpr double margin =
    16; // fragments kept around a block, so that clipped edges' snapping stays outside it
constexpr std::size_t boxes_at_most = 1024;

// The half-space normal . P >= offset.
struct HalfSpace {
  glm::dvec3 normal;
  double offset;

  double height(const glm::dvec3 &p) const { return glm::dot(normal, p) - offset; }
};

using Frustum = std::array<HalfSpace, 5>;
using Polygon = std::vector<glm::dvec3>;

// In front of the lens, and between the block's borders widened by the margin.
Frustum frustum_of(const RasterBlock &block) {
  const glm::dmat3 rows = glm::transpose(block.raster_from_camera);
  const glm::dvec2 high = glm::dvec2(block.fragments) + margin;
  return {{{rows[2], nearest_depth_m},
           {rows[0] + margin * rows[2], 0},
           {high.x * rows[2] - rows[0], 0},
           {rows[1] + margin * rows[2], 0},
           {high.y * rows[2] - rows[1], 0}}};
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

shader::RasterVertex raster_vertex(const glm::dvec3 &p, const RasterBlock &block, std::uint32_t triangle) {
  const glm::dvec3 h = block.raster_from_camera * p;
  const glm::dvec2 snapped = glm::roundEven(glm::dvec2(h) / h.z * grid) / grid;
  return {static_cast<float>(snapped.x), static_cast<float>(snapped.y), static_cast<float>(0.5 / h.z),
          triangle};
}

void project_block(const CameraScene &camera, std::size_t triangles_per_box, RasterBlock &block,
                   Projection &projection) {
  const Frustum frustum = frustum_of(block);
  Polygon polygon, scratch;
  block.first_vertex = static_cast<std::uint32_t>(projection.vertices.size());
  for (std::size_t i = 0; i < camera.triangles.size(); ++i) {
    const CameraTriangle &triangle = camera.triangles[i];
    polygon.assign(triangle.corners_m.begin(), triangle.corners_m.end());
    for (std::size_t side = 0; side < frustum.size() && !polygon.empty(); ++side)
      clip(polygon, scratch, frustum[side]);
    if (polygon.size() < 3)
      continue;
    for (const glm::dvec3 &p : polygon)
      projection.visible[i / triangles_per_box].add(p);
    const auto vertex = [&](std::size_t k) { return raster_vertex(polygon[k], block, triangle.id); };
    for (std::size_t k = 2; k < polygon.size(); ++k)
      projection.vertices.insert(projection.vertices.end(), {vertex(0), vertex(k - 1), vertex(k)});
  }
  block.vertex_count = static_cast<std::uint32_t>(projection.vertices.size()) - block.first_vertex;
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

Seen seen_in(const RasterBlock &block, std::span<const glm::dvec3> corners_m) {
  // In the raster's frame (x, y, depth), before x and y are divided by the depth.
  std::array<glm::dvec3, 3> places;
  for (std::size_t i = 0; i < corners_m.size(); ++i)
    places[i] = block.raster_from_camera * corners_m[i];
  Seen seen;
  const auto add = [&](const glm::dvec3 &h) {
    seen.outline.add(glm::dvec2(h) / h.z);
    seen.nearest_m = std::min(seen.nearest_m, h.z);
    seen.farthest_m = std::max(seen.farthest_m, h.z);
  };
  for (std::size_t i = 0; i < corners_m.size(); ++i) {
    const glm::dvec3 &from = places[i], &to = places[i + 1 < corners_m.size() ? i + 1 : 0];
    if (from.z >= nearest_depth_m)
      add(from);
    if ((from.z >= nearest_depth_m) != (to.z >= nearest_depth_m))
      add(from + (to - from) * ((nearest_depth_m - from.z) / (to.z - from.z)));
  }
  return seen;
}

Projection project(const CameraScene &camera, std::vector<RasterBlock> blocks) {
  Projection projection;
  projection.blocks = std::move(blocks);
  // Consecutive triangles share a box.
  const std::size_t triangles_per_box = camera.triangles.size() / boxes_at_most + 1;
  projection.visible.resize(camera.triangles.size() / triangles_per_box + 1);
  for (RasterBlock &block : projection.blocks)
    project_block(camera, triangles_per_box, block, projection);
  scale_depths(projection);
  // Boxes in which nothing is visible.
  std::erase_if(projection.visible, [](const VisibleBox &box) { return box.low_m.x > box.high_m.x; });
  return projection;
}

} // namespace pmdsim
