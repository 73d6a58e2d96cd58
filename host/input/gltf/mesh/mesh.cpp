#include "host/input/gltf/mesh/mesh.h"

#include "host/input/file/memory_request.h"
#include "host/input/gltf/data/accessor.h"
#include "host/input/gltf/mesh/attributes.h"
#include "host/input/schema/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <tiny_gltf.h>

namespace pmdsim {
namespace {

// That of a point of its material's area.
double material_radius_m(const GltfPrimitive &primitive, const GltfMaterial &material) {
  const double radius_m = std::sqrt(material.point_area_m2.value_or(0.0) / std::numbers::pi);
  if (radius_m == 0.0)
    throw input_error(primitive.place, "points without a size, expected the attribute _RADIUS or a material "
                                       "with extras.pmdsim_point_area_m2");
  return radius_m;
}

// The world radius of each of a POINTS primitive's vertices: the attribute _RADIUS, in the mesh's units, else
// that of the area extras.pmdsim_point_area_m2 of its material. The node scales both with the cube root of
// its change of volume; but an area's radius stays where positions are quantized, for their node's scale is
// part of the quantization and their unit no metre. Throws Error (input) at the primitive.
std::vector<double> point_radii_m(const GltfPrimitive &primitive, const GltfMaterial &material,
                                  const Placement &placement, std::size_t vertex_count) {
  std::vector<double> radii = read_radii(primitive);
  const bool is_scaled = !radii.empty() || !is_quantized(primitive);
  if (radii.empty())
    radii.assign(vertex_count, material_radius_m(primitive, material));
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (is_scaled)
      radii[i] *= std::cbrt(std::abs(glm::determinant(placement.world_from_mesh(i).linear)));
    if (!(radii[i] <= max_coordinate_m))
      throw input_error(primitive.place, fmt::format("vertex {} has a radius of {} m, expected at most {} m",
                                                     i, radii[i], max_coordinate_m));
  }
  return radii;
}

// A disc for each index, but for points smaller than min_length_m: what a node scales to nothing is not
// there.
void append_discs(const std::vector<std::uint32_t> &indices, const std::vector<double> &radii_m,
                  std::uint32_t first_vertex, std::uint32_t surface, std::uint32_t object, Scene &scene) {
  for (const std::uint32_t index : indices)
    if (radii_m[index] >= min_length_m)
      scene.discs.push_back({first_vertex + index, radii_m[index], surface, object});
}

// To either side of 0, of a coordinate on a texture; far beyond it nothing is left of a float's fraction.
constexpr double max_texture_coordinate = 1e6;

using Corners = std::array<std::uint32_t, 3>; // places in the list of indices

void refuse_other_geometry(const tinygltf::Primitive &primitive, const Place &place) {
  if (primitive.mode > TINYGLTF_MODE_POINTS && primitive.mode < TINYGLTF_MODE_TRIANGLES)
    throw input_error(place / "mode",
                      "lines are not supported (expected points: 0, or triangles: 4, 5 or 6)");
  if (!primitive.targets.empty())
    throw input_error(place / "targets", "morph targets are not supported yet");
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

std::vector<std::uint32_t> vertex_indices(const GltfPrimitive &primitive, std::size_t vertex_count) {
  if (primitive.data.indices >= 0)
    return read_indices(primitive.model, static_cast<std::size_t>(primitive.data.indices), vertex_count,
                        Place{primitive.place.file});
  std::vector<std::uint32_t> indices(vertex_count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

// Makes `all` as long as `count` more vertices after `before` need it: with `values`, and white or (0, 0) for
// vertices that have none. It stays empty as long as none has.
template <class T>
void extend(std::vector<T> &all, const std::vector<T> &values, T absent, std::size_t before,
            std::size_t count) {
  if (all.empty() && values.empty())
    return;
  all.resize(before, absent);
  all.insert(all.end(), values.begin(), values.end());
  all.resize(before + count, absent);
}

std::vector<glm::dvec2> texture_coordinates(const GltfPrimitive &primitive, const GltfMaterial &material) {
  if (!material.surface.paint || !material.surface.paint->texture)
    return {};
  std::vector<glm::dvec2> coordinates = read_texture_coordinates(primitive, material.texture_coordinates);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    coordinates[i] = glm::dvec2(material.texture_from_coordinates * glm::dvec3(coordinates[i], 1.0));
    const glm::dvec2 size = glm::abs(coordinates[i]);
    if (!(size.x <= max_texture_coordinate && size.y <= max_texture_coordinate))
      throw input_error(primitive.place,
                        fmt::format("vertex {} lies outside the texture, expected coordinates from {} to {}",
                                    i, -max_texture_coordinate, max_texture_coordinate));
  }
  return coordinates;
}

std::vector<glm::vec4> colours(const GltfPrimitive &primitive, const GltfMaterial &material) {
  std::vector<glm::vec4> result = read_colours(primitive);
  if (material.blended && std::ranges::any_of(result, [](const glm::vec4 &rgba) { return rgba.a < 1.0f; }))
    throw input_error(
        primitive.place / "attributes" / "COLOR_0",
        "an alpha below 1 is not supported under alphaMode BLEND (expected \"MASK\" or \"OPAQUE\")");
  return result;
}

// By vertex, as each may be many triangles' and bound to many joints.
std::vector<bool> mirrored_vertices(const Placement &placement, std::size_t vertex_count) {
  std::vector<bool> mirrored(vertex_count);
  for (std::size_t i = 0; i < vertex_count; ++i)
    mirrored[i] = glm::determinant(placement.world_from_mesh(i).linear) < 0.0;
  return mirrored;
}

void append_triangles(const std::vector<Corners> &triangles, const std::vector<std::uint32_t> &indices,
                      const std::vector<bool> &mirrored, std::uint32_t first_vertex, std::uint32_t surface,
                      std::uint32_t object, Scene &scene) {
  for (Corners corners : triangles) {
    if (mirrored[indices[corners[0]]])
      std::swap(corners[1], corners[2]);
    const auto vertex = [&](std::size_t k) { return first_vertex + indices[corners[k]]; };
    scene.triangles.push_back({{vertex(0), vertex(1), vertex(2)}, surface, object});
  }
}

} // namespace

void append_primitive(const GltfPrimitive &primitive, const PrimitiveUse &use, std::size_t &shapes,
                      Scene &scene) {
  const tinygltf::Primitive &data = primitive.data;
  const Place &place = primitive.place;
  refuse_other_geometry(data, place);
  const std::vector<glm::dvec4> positions = read_positions(primitive);
  const std::size_t before = scene.positions_m.size(), count = positions.size();
  const std::vector<std::uint32_t> indices = vertex_indices(primitive, count);
  shapes += indices.size();
  if (before + count > max_scene_vertices || shapes > max_scene_vertices)
    throw input_error(
        place, fmt::format("the scene has more than {} vertices, triangles or points", max_scene_vertices));

  // Positions are there twice until they are the scene's, whose lists may grow to twice what they hold.
  require_memory(count * 4 * sizeof(glm::dvec3) + indices.size() * sizeof(Triangle), place, "its geometry");
  const std::vector<glm::dvec3> world = world_positions(positions, use.placement, place);
  const auto first_vertex = static_cast<std::uint32_t>(before);
  if (data.mode == TINYGLTF_MODE_POINTS)
    append_discs(indices, point_radii_m(primitive, use.material, use.placement, count), first_vertex,
                 use.surface, use.object, scene);
  else
    append_triangles(triangle_corners(data.mode, static_cast<std::uint32_t>(indices.size()), place), indices,
                     mirrored_vertices(use.placement, count), first_vertex, use.surface, use.object, scene);
  extend(scene.colours, colours(primitive, use.material), glm::vec4(1.0f), before, count);
  extend(scene.texture_coordinates, texture_coordinates(primitive, use.material), glm::dvec2(0.0), before,
         count);
  scene.positions_m.insert(scene.positions_m.end(), world.begin(), world.end());
}

} // namespace pmdsim
