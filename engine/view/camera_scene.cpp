#include "engine/view/camera_scene.h"

#include "engine/vulkan/float_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace pmdsim {
namespace {

// Empty where the lens cannot see a triangle in this plane from where it stands.
std::optional<Plane> seen_plane(const Plane &plane, bool double_sided) {
  if (plane.offset_m == 0.0 || (plane.offset_m > 0.0 && !double_sided))
    return std::nullopt;
  return plane.offset_m < 0.0 ? plane : Plane{-plane.normal, -plane.offset_m};
}

struct Bounds {
  double low, high;
};

Bounds depths_m(const std::array<glm::dvec3, 3> &corners_m) {
  const auto [nearest, farthest] = std::minmax({corners_m[0].z, corners_m[1].z, corners_m[2].z});
  return {nearest, farthest};
}

double distance_to_edge_m(const glm::dvec3 &from, const glm::dvec3 &to) {
  const glm::dvec3 edge = to - from;
  const double along = std::clamp(-glm::dot(from, edge) / glm::dot(edge, edge), 0.0, 1.0);
  return glm::length(from + along * edge);
}

// The ranges of the triangle's points from the lens: the nearest lies on an edge, or below the lens if that
// is over the triangle.
Bounds ranges_m(const std::array<glm::dvec3, 3> &corners_m, const Plane &plane) {
  const auto &[a, b, c] = corners_m;
  const glm::dvec3 below = plane.offset_m * plane.normal;
  const auto side = [&](const glm::dvec3 &from, const glm::dvec3 &to) {
    return glm::dot(plane.normal, glm::cross(to - from, below - from));
  };
  const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
  const bool over = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  return {over ? -plane.offset_m
               : std::min({distance_to_edge_m(a, b), distance_to_edge_m(b, c), distance_to_edge_m(c, a)}),
          std::max({glm::length(a), glm::length(b), glm::length(c)})};
}

// An equilateral triangle around the disc, which faces the lens; a little wider, so that the raster's
// snapping takes nothing of a disc that is not much smaller than a sample.
std::array<glm::dvec3, 3> around_disc(const glm::dvec3 &centre_m, double radius_m) {
  const glm::dvec3 view = glm::normalize(centre_m);
  const glm::dvec3 aside =
      std::abs(view.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0); // not along the view
  const glm::dvec3 u = glm::normalize(glm::cross(view, aside)), v = glm::cross(view, u);
  const double reach_m = 2.02 * radius_m;
  return {centre_m + reach_m * v, centre_m + reach_m * (-0.5 * std::numbers::sqrt3 * u - 0.5 * v),
          centre_m + reach_m * (0.5 * std::numbers::sqrt3 * u - 0.5 * v)};
}

// The lens is taken off first: what is left is small, wherever in the world the scene stands.
glm::dvec3 in_camera(const glm::dvec3 &world_m, const Pose &world_from_camera) {
  return glm::transpose(world_from_camera.rotation) * (world_m - world_from_camera.translation_m);
}

void add_triangle(CameraScene &camera, const Scene &scene, std::uint32_t id, const Pose &world_from_camera) {
  const Triangle &triangle = scene.triangles[id];
  CameraTriangle seen{{}, id};
  for (std::size_t k = 0; k < 3; ++k)
    seen.corners_m[k] = in_camera(scene.positions_m[triangle.vertices[k]], world_from_camera);
  const auto front = front_plane(seen.corners_m);
  if (!front)
    return;
  if (const auto plane = seen_plane(*front, scene.surfaces[triangle.surface].double_sided)) {
    camera.triangles.push_back(seen);
    camera.planes.push_back(*plane);
  } else {
    camera.hidden.push_back(seen);
  }
}

void add_disc(CameraScene &camera, const Scene &scene, std::size_t index, const Pose &world_from_camera) {
  const Disc &disc = scene.discs[index];
  const glm::dvec3 centre_m = in_camera(scene.positions_m[disc.vertex], world_from_camera);
  const double range_m = glm::length(centre_m);
  if (!(range_m > 0.0))
    return;
  camera.triangles.push_back(
      {around_disc(centre_m, disc.radius_m), static_cast<std::uint32_t>(scene.triangles.size() + index)});
  camera.planes.push_back({-centre_m / range_m, -range_m});
}

} // namespace

std::optional<Plane> front_plane(const std::array<glm::dvec3, 3> &corners_m) {
  const glm::dvec3 area = glm::cross(corners_m[1] - corners_m[0], corners_m[2] - corners_m[0]);
  const double length = glm::length(area);
  if (!(length > 0.0))
    return std::nullopt;
  const glm::dvec3 normal = area / length;
  return Plane{normal, glm::dot(normal, corners_m[0])};
}

CameraScene to_camera(const Scene &scene, const Sensor &sensor) {
  CameraScene camera;
  camera.world_rounding_m =
      8.0 * std::numeric_limits<double>::epsilon() * glm::length(sensor.world_from_camera.translation_m);
  camera.triangles.reserve(scene.shape_count());
  camera.planes.reserve(scene.shape_count());
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id)
    add_triangle(camera, scene, id, sensor.world_from_camera);
  for (std::size_t i = 0; i < scene.discs.size(); ++i)
    add_disc(camera, scene, i, sensor.world_from_camera);
  return camera;
}

double backscatter_per_reflectivity(Backscatter backscatter) {
  return backscatter == Backscatter::lambert ? std::numbers::inv_pi : 1.0;
}

std::vector<shader::TrianglePlane> triangle_planes(const CameraScene &camera, const Scene &scene,
                                                   Backscatter backscatter, AlongRay along) {
  // A hair wider than the triangle, so that rounding to float never clamps a true hit.
  constexpr double slack = 1e-6;
  const double per_reflectivity = backscatter_per_reflectivity(backscatter);
  std::vector<shader::TrianglePlane> records(scene.shape_count());
  for (std::size_t i = 0; i < camera.triangles.size(); ++i) {
    const auto &[corners_m, id] = camera.triangles[i];
    const Plane &plane = camera.planes[i];
    const auto [nearest_m, farthest_m] =
        along == AlongRay::depth ? depths_m(corners_m) : ranges_m(corners_m, plane);
    const DoublePair4 pair(plane.normal, plane.offset_m);
    records[id] = {pair.hi,
                   pair.lo,
                   static_cast<float>(scene.surfaces[scene.surface_of(id)].reflectivity * per_reflectivity),
                   scene.object_of(id),
                   static_cast<float>(std::max(0.0, nearest_m) * (1.0 - slack)),
                   static_cast<float>(std::max(0.0, farthest_m) * (1.0 + slack))};
  }
  return records;
}

} // namespace pmdsim
