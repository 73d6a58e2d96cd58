#pragma once
// A glTF primitive's vertex attributes, in the types that glTF 2.0 and KHR_mesh_quantization allow for each.

#include "host/input/file/input_error.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tinygltf {
class Model;
struct Primitive;
} // namespace tinygltf

namespace pmdsim {

struct GltfPrimitive {
  const tinygltf::Model &model;
  const tinygltf::Primitive &data;
  Place place; // /meshes/I/primitives/K
};

// They throw Error (input): at the accessor for what is wrong in it, at the primitive for an attribute that
// is missing or has not as many elements as POSITION.

std::vector<glm::dvec4> read_positions(const GltfPrimitive &primitive); // w is 0
// COLOR_0, linear RGBA, 0 to 1; empty where the primitive has none.
std::vector<glm::vec4> read_colours(const GltfPrimitive &primitive);
// TEXCOORD_`set`, which has to be there.
std::vector<glm::dvec2> read_texture_coordinates(const GltfPrimitive &primitive, std::uint32_t set);
// _RADIUS, above 0; empty where the primitive has none.
std::vector<double> read_radii(const GltfPrimitive &primitive);

// The accessors of JOINTS_n and WEIGHTS_n, whose components have the right type.
struct WeightSet {
  std::size_t joints, weights;
};
// n = 0, 1, ... At least one.
std::vector<WeightSet> weight_sets(const GltfPrimitive &primitive);

bool is_quantized(const GltfPrimitive &primitive); // its POSITION

} // namespace pmdsim
