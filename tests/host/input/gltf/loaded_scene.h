#pragma once
// The scene that a glTF document loads as, or the error if it does not load.

#include "host/input/gltf/loader.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

inline GltfFile file_of(const nlohmann::json &gltf) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.gltf", gltf.dump());
  return load_gltf(file, Place{file});
}

inline GltfScene gltf_scene_of(const nlohmann::json &gltf) { return file_of(gltf).at(0); }

inline Scene scene_of(const nlohmann::json &gltf) { return gltf_scene_of(gltf).scene; }

inline std::string scene_error_of(const nlohmann::json &gltf) {
  return input_error_of([&] { scene_of(gltf); });
}

// The corners of its triangles.
using Ids = std::vector<std::array<std::uint32_t, 3>>;

inline Ids vertices_of(const Scene &scene) {
  Ids ids;
  for (const Triangle &triangle : scene.triangles)
    ids.push_back(triangle.vertices);
  return ids;
}

// The files hold floats.
inline constexpr double float_rounding = 1e-6;

} // namespace pmdsim::test
