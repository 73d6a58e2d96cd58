#pragma once
// The numbers behind a glTF accessor. Every range is checked; nothing is assumed of what a file states.

#include "host/input/input_error.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

// Both read /accessors/`accessor`, which exists, and throw Error (input) at that place.

// Float VEC3, all finite.
std::vector<glm::vec3> read_positions(const tinygltf::Model &model, std::size_t accessor, const Place &root);
// SCALAR of 8, 16 or 32 bit, each below `vertex_count`, none the primitive restart value.
std::vector<std::uint32_t> read_indices(const tinygltf::Model &model, std::size_t accessor,
                                        std::size_t vertex_count, const Place &root);

} // namespace pmdsim
