#include "host/input/gltf_mesh.h"

#include "host/input/gltf_accessor.h"
#include "host/input/limits.h"

#include <array>
#include <fmt/format.h>
#include <numeric>
#include <tiny_gltf.h>

namespace pmdsim {

namespace {

using Corners = std::array<std::uint32_t, 3>; // places in the list of indices

void refuse_other_geometry(const tinygltf::Primitive &primitive, const Place &place) {
  if (primitive.mode == TINYGLTF_MODE_POINTS)
    throw input_error(place / "mode", "points are not supported yet (expected triangles: 4, 5 or 6)");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES)
    throw input_error(place / "mode", "lines are not supported (expected triangles: 4, 5 or 6)");
  if (!primitive.targets.empty())
    throw input_error(place / "targets", "morph targets are not supported yet");
  if (primitive.attributes.contains("COLOR_0"))
    throw input_error(place / "attributes" / "COLOR_0", "vertex colours are not supported yet");
  if (!primitive.attributes.contains("POSITION"))
    throw input_error(place / "attributes", "missing key \"POSITION\"");
}

// glTF 2.0, section 3.7.2.1: which of `count` indices form which triangle.
std::vector<Corners> triangle_corners(int mode, std::uint32_t count, const Place &place) {
  if (count < 3 || (mode == TINYGLTF_MODE_TRIANGLES && count % 3 != 0))
    throw input_error(place, fmt::format("{} vertices make no whole triangles", count));
  std::vector<Corners> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES)
    for (std::uint32_t i = 0; i < count; i += 3)
      triangles.push_back({i, i + 1, i + 2});
  else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
    for (std::uint32_t i = 0; i + 2 < count; ++i)
      triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
  else
    for (std::uint32_t i = 0; i + 2 < count; ++i)
      triangles.push_back({i + 1, i + 2, 0});
  return triangles;
}

std::vector<glm::dvec3> world_positions(const std::vector<glm::dvec4> &positions, const Placement &placement,
                                        const Place &place) {
  std::vector<glm::dvec3> world;
  world.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    world.push_back(placement.world_from_mesh(i).point(glm::dvec3(positions[i])));
    if (!is_position(world.back()))
      throw input_error(place,
                        fmt::format("vertex {} lies outside the world, expected coordinates from {} to {} m",
                                    i, -max_coordinate_m, max_coordinate_m));
  }
  return world;
}

} // namespace

void append_primitive(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                      const Placement &placement, std::uint32_t surface, std::uint32_t object,
                      const Place &place, Scene &scene) {
  refuse_other_geometry(primitive, place);
  const Place root{place.file};
  const auto accessor = static_cast<std::size_t>(primitive.attributes.at("POSITION"));
  const std::vector<glm::dvec4> positions = read_vectors(model, accessor, 3, root);
  std::vector<std::uint32_t> indices(positions.size());
  if (primitive.indices < 0)
    std::iota(indices.begin(), indices.end(), 0u);
  else
    indices = read_indices(model, static_cast<std::size_t>(primitive.indices), positions.size(), root);
  if (scene.positions_m.size() + positions.size() > max_scene_vertices ||
      scene.triangles.size() + indices.size() > max_scene_vertices)
    throw input_error(place,
                      fmt::format("the scene has more than {} vertices or triangles", max_scene_vertices));

  const std::vector<glm::dvec3> world = world_positions(positions, placement, place);
  const auto first_vertex = static_cast<std::uint32_t>(scene.positions_m.size());
  for (Corners corners :
       triangle_corners(primitive.mode, static_cast<std::uint32_t>(indices.size()), place)) {
    if (glm::determinant(placement.world_from_mesh(indices[corners[0]]).linear) < 0.0)
      std::swap(corners[1], corners[2]);
    const auto vertex = [&](std::size_t k) { return first_vertex + indices[corners[k]]; };
    scene.triangles.push_back({{vertex(0), vertex(1), vertex(2)}, surface, object});
  }
  scene.positions_m.insert(scene.positions_m.end(), world.begin(), world.end());
}

} // namespace pmdsim
