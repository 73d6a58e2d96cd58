#pragma once
// The numbers behind a glTF accessor, plain or sparse. Every range is checked; nothing is assumed of what a
// file states.

#include "host/input/file/input_error.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

// The bytes of /bufferViews/`view`, which exists. Throws Error (input) there where its buffer ends before it.
std::span<const unsigned char> bytes_of_view(const tinygltf::Model &model, std::size_t view,
                                             const Place &root);

// All read /accessors/`accessor`, which exists, and throw Error (input) at that place.

// SCALAR to VEC4 of `components` components (1 to 4), all finite: floats, or integers as
// KHR_mesh_quantization, colours, weights and animations allow them; normalized ones become -1 to 1 or 0
// to 1. Components that a vector lacks are 0.
std::vector<glm::dvec4> read_vectors(const tinygltf::Model &model, std::size_t accessor, int components,
                                     const Place &root);
// The first `count` of a MAT4 of floats, all finite.
std::vector<glm::dmat4> read_matrices(const tinygltf::Model &model, std::size_t accessor, std::size_t count,
                                      const Place &root);
// SCALAR of 8, 16 or 32 bit, each below `vertex_count`, none the primitive restart value.
std::vector<std::uint32_t> read_indices(const tinygltf::Model &model, std::size_t accessor,
                                        std::size_t vertex_count, const Place &root);

} // namespace pmdsim
