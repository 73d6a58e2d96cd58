#pragma once
// Adds what moves to small glTF documents: accessors with a buffer each, animations and skins.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

// Returns the accessor's index.
std::size_t add_accessor(nlohmann::json &gltf, const std::string &bytes, int component_type,
                         std::size_t count, const std::string &type);
std::size_t add_floats(nlohmann::json &gltf, const std::vector<float> &values, const std::string &type);

// A new animation with one channel: `path` of `node`; VEC4 for "rotation", else VEC3.
void animate(nlohmann::json &gltf, std::size_t node, const std::string &path,
             const std::string &interpolation, const std::vector<float> &times_s,
             const std::vector<float> &values);

// Node 0 "arm" carries the mesh, nodes 1 "lower" and 2 "upper", its child at (0, 1, 0), are the joints of
// skin 0, bound where they stand. Vertices: (0, 0, 0) on lower, (1, 1, 0) on both, (0, 2, 0) on upper.
nlohmann::json skinned_arm();

// A quarter turn about z, as x, y, z, w.
std::vector<float> quarter_turn();

} // namespace pmdsim::test
