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

// They throw Error (input): at the accessor for what is wrong in it, at `place` (/meshes/I/primitives/K) for
// an attribute that is missing or has not `vertex_count` elements.

std::vector<glm::dvec4> read_positions(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                       const Place &place); // w is 0
// COLOR_0, linear RGBA, 0 to 1; empty where the primitive has none.
std::vector<glm::vec4> read_colours(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                                    std::size_t vertex_count, const Place &place);
// TEXCOORD_`set`, which has to be there.
std::vector<glm::dvec2> read_texture_coordinates(const tinygltf::Model &model,
                                                 const tinygltf::Primitive &primitive, std::uint32_t set,
                                                 std::size_t vertex_count, const Place &place);
// _RADIUS, above 0; empty where the primitive has none.
std::vector<double> read_radii(const tinygltf::Model &model, const tinygltf::Primitive &primitive,
                               std::size_t vertex_count, const Place &place);

bool is_quantized(const tinygltf::Model &model, const tinygltf::Primitive &primitive); // its POSITION

} // namespace pmdsim
