#include "host/input/gltf/mesh/points.h"

#include "host/input/gltf/mesh/attributes.h"
#include "host/input/schema/limits.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <tiny_gltf.h>

namespace pmdsim {

namespace {

constexpr const char *area_key = "pmdsim_point_area_m2";

// That of a point of its material's area; 0 where the material has none.
double material_radius_m(const tinygltf::Model &model, const tinygltf::Primitive &primitive) {
  if (primitive.material < 0)
    return 0.0;
  const tinygltf::Value &extras = model.materials[static_cast<std::size_t>(primitive.material)].extras;
  if (!extras.IsObject() || !extras.Has(area_key))
    return 0.0;
  return std::sqrt(extras.Get(area_key).GetNumberAsDouble() / std::numbers::pi);
}

} // namespace

std::vector<double> point_radii_m(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                  const Placement &placement, std::size_t vertex_count, const Place &place) {
  const auto scale = [&](std::size_t vertex) {
    return std::cbrt(std::abs(glm::determinant(placement.world_from_mesh(vertex).linear)));
  };
  std::vector<double> radii = read_radii(model, primitive, vertex_count, place);
  const bool of_an_area = radii.empty();
  if (of_an_area) {
    const double radius_m = material_radius_m(model, primitive);
    if (radius_m == 0.0)
      throw input_error(place, fmt::format("points without a size, expected the attribute _RADIUS or a "
                                           "material with extras.{}",
                                           area_key));
    radii.assign(vertex_count, radius_m);
  }
  if (!of_an_area || !is_quantized(model, primitive))
    for (std::size_t i = 0; i < radii.size(); ++i)
      radii[i] *= scale(i);
  for (std::size_t i = 0; i < radii.size(); ++i)
    if (!(radii[i] <= max_coordinate_m))
      throw input_error(place, fmt::format("vertex {} has a radius of {} m, expected at most {} m", i,
                                           radii[i], max_coordinate_m));
  return radii;
}

void append_discs(const std::vector<std::uint32_t> &indices, const std::vector<double> &radii_m,
                  std::uint32_t first_vertex, std::uint32_t surface, std::uint32_t object, Scene &scene) {
  for (const std::uint32_t index : indices)
    if (radii_m[index] >= min_length_m)
      scene.discs.push_back({first_vertex + index, radii_m[index], surface, object});
}

} // namespace pmdsim
