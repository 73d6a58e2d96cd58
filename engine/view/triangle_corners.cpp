#include "engine/view/triangle_corners.h"

#include "engine/view/welded_edges.h"
#include "engine/vulkan/float_pair.h"

namespace pmdsim {
namespace {

std::vector<std::uint32_t> visible_triangles(const CameraScene &camera, const Scene &scene) {
  std::vector<std::uint32_t> ids;
  for (const CameraTriangle &triangle : camera.triangles)
    if (triangle.id < scene.triangles.size()) // discs stand alone
      ids.push_back(triangle.id);
  return ids;
}

} // namespace

std::vector<shader::TriangleCorners> triangle_corners(const CameraScene &camera, const Scene &scene) {
  std::vector<shader::TriangleCorners> records(scene.shape_count());
  for (const auto &[corners_m, id] : camera.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const DoublePair4 pair(corners_m[k], 0.0);
      records[id].hi[k] = pair.hi;
      records[id].lo[k] = pair.lo;
      records[id].beyond[k] = shader::no_triangle;
    }
  // Where more than two triangles share an edge, neighbours in the order of their ids.
  const std::vector<WeldedEdge> edges =
      welded_edges(scene, visible_triangles(camera, scene), first_at_same_place(scene.positions_m));
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const WeldedEdge &a = edges[i - 1], &b = edges[i];
    if (a.low != b.low || a.high != b.high)
      continue;
    records[b.triangle].beyond[b.side] = a.triangle;
    if (records[a.triangle].beyond[a.side] == shader::no_triangle)
      records[a.triangle].beyond[a.side] = b.triangle;
  }
  return records;
}

} // namespace pmdsim
