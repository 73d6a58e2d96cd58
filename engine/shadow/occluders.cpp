#include "engine/shadow/occluders.h"

#include "engine/shadow/point_set.h"
#include "engine/view/mesh_edges.h"
#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace pmdsim {
namespace {

// The rounding of rotations and dot products in double, relative to the coordinates.
constexpr double relative_rounding = 1e-14;

// The corners of all that the lens sees, each of the scene's vertices once.
PlaceSet seen_corners(const CameraScene &camera, const Scene &scene) {
  std::vector<glm::dvec3> corners_m;
  std::vector<bool> is_there(scene.positions_m.size());
  for (const auto &[corners_of_m, id] : camera.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_vertex = id < scene.triangles.size(); // a disc's corners are its own
      if (is_vertex && is_there[scene.triangles[id].vertices[k]])
        continue;
      if (is_vertex)
        is_there[scene.triangles[id].vertices[k]] = true;
      corners_m.push_back(corners_of_m[k]);
    }
  return PlaceSet(std::move(corners_m));
}

std::vector<glm::dvec3> all_diodes_m(const std::vector<CameraIlluminator> &illuminators) {
  std::vector<glm::dvec3> positions_m;
  for (const CameraIlluminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes)
      positions_m.push_back(diode.position_m);
  return positions_m;
}

bool may_have_holes(const Scene &scene, std::uint32_t id) { return scene.is_disc(id) || scene.is_masked(id); }

shader::Occluder occluder_of(const CameraTriangle &triangle, const Plane &plane) {
  const auto &[a, b, c] = triangle.corners_m;
  const DoublePair4 plane_pair(plane.normal, plane.offset_m), a_pair(a, 0.0), b_pair(b, 0.0), c_pair(c, 0.0);
  const auto turned = [](const glm::dvec3 &from, const glm::dvec3 &to) {
    return comes_before(to, from) ? 1u : 0u;
  };
  return {plane_pair.hi,
          plane_pair.lo,
          a_pair.hi,
          b_pair.hi,
          c_pair.hi,
          a_pair.lo,
          b_pair.lo,
          c_pair.lo,
          triangle.id,
          turned(a, b) | turned(b, c) << 1 | turned(c, a) << 2,
          0,
          0};
}

} // namespace

Occluders find_occluders(const CameraScene &camera, const Scene &scene,
                         const std::vector<CameraIlluminator> &illuminators) {
  PlaceSet seen = seen_corners(camera, scene), diodes(all_diodes_m(illuminators));
  Occluders occluders;
  occluders.shapes.reserve(camera.triangles.size() + camera.hidden.size());
  const auto add = [&](const CameraTriangle &triangle) {
    const auto plane = front_plane(triangle.corners_m);
    if (!plane)
      return;
    const double margin_m =
        camera.world_rounding_m +
        relative_rounding * (std::abs(plane->offset_m) + std::max(seen.size_m(), diodes.size_m()));
    if ((diodes.any_above(*plane, margin_m) && seen.any_below(*plane, margin_m)) ||
        (diodes.any_below(*plane, margin_m) && seen.any_above(*plane, margin_m)))
      (may_have_holes(scene, triangle.id) ? occluders.with_holes : occluders.shapes)
          .push_back(occluder_of(triangle, *plane));
  };
  std::ranges::for_each(camera.triangles, add);
  std::ranges::for_each(camera.hidden, add);
  return occluders;
}

} // namespace pmdsim
