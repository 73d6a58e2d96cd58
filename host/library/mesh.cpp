#include "host/library/mesh.h"

#include "host/input/schema/limits.h"
#include "host/library/calls.h"

#include <fmt/format.h>
#include <map>
#include <span>

namespace pmdsim::library {
namespace {

constexpr std::size_t most = std::size_t{1} << 30; // vertices and triangles, each; their ids have 32 bits

template <class T>
std::span<const T> array(const T *values, std::size_t count, std::size_t width, const char *name) {
  if (count > most)
    throw bad_argument(fmt::format("mesh: expected at most {} {}, found {}", most, name, count));
  if (count > 0 && !values)
    throw bad_argument(fmt::format("mesh: expected {} {}, found NULL", count, name));
  return {values, count * width};
}

std::vector<glm::dvec3> positions_of(const pmdsim_mesh &mesh) {
  const auto values = array(mesh.positions_m, mesh.vertex_count, 3, "positions_m");
  std::vector<glm::dvec3> positions_m;
  positions_m.reserve(mesh.vertex_count);
  for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
    positions_m.emplace_back(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    if (!is_position(positions_m.back()))
      throw bad_argument(fmt::format(
          "mesh: positions_m: vertex {}: expected numbers from {} to {}, found {}, {}, {}", i,
          -max_coordinate_m, max_coordinate_m, values[3 * i], values[3 * i + 1], values[3 * i + 2]));
  }
  return positions_m;
}

// A surface for each reflectivity that there is.
class SurfacesByReflectivity {
public:
  SurfacesByReflectivity(bool double_sided, std::vector<Surface> &surfaces)
      : double_sided_(double_sided), surfaces_(surfaces) {}

  std::uint32_t operator[](double reflectivity) {
    const auto [known, is_new] =
        known_.try_emplace(reflectivity, static_cast<std::uint32_t>(surfaces_.size()));
    if (is_new)
      surfaces_.push_back({.reflectivity = reflectivity, .double_sided = double_sided_});
    return known->second;
  }

private:
  bool double_sided_;
  std::vector<Surface> &surfaces_;
  std::map<double, std::uint32_t> known_;
};

} // namespace

Scene scene_of(const pmdsim_mesh &mesh) {
  Scene scene;
  scene.positions_m = positions_of(mesh);
  const auto vertices = array(mesh.triangles, mesh.triangle_count, 3, "triangles");
  SurfacesByReflectivity surfaces(mesh.double_sided != 0, scene.surfaces);
  std::uint32_t objects = 0;
  scene.triangles.reserve(mesh.triangle_count);
  for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
    Triangle triangle{{vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]}, 0, 0};
    for (const std::uint32_t vertex : triangle.vertices)
      if (vertex >= mesh.vertex_count)
        throw bad_argument(fmt::format("mesh: triangles: triangle {}: expected vertices below {}, found {}",
                                       i, mesh.vertex_count, vertex));
    const double reflectivity = mesh.reflectivity ? mesh.reflectivity[i] : 1.0;
    if (!(reflectivity >= 0.0 && reflectivity <= 1.0))
      throw bad_argument(fmt::format(
          "mesh: reflectivity: triangle {}: expected a number from 0 to 1, found {}", i, reflectivity));
    triangle.surface = surfaces[reflectivity];
    triangle.object = mesh.object_ids ? mesh.object_ids[i] : 0;
    if (triangle.object >= mesh.triangle_count)
      throw bad_argument(fmt::format("mesh: object_ids: triangle {}: expected an id below {}, found {}", i,
                                     mesh.triangle_count, triangle.object));
    objects = std::max(objects, triangle.object + 1);
    scene.triangles.push_back(triangle);
  }
  for (std::uint32_t i = 0; i < objects; ++i)
    scene.objects.push_back(fmt::format("object {}", i));
  return scene;
}

} // namespace pmdsim::library
