#pragma once
// What a glTF document loads as, or why it does not.

#include "host/input/gltf/loader.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim::test {

inline GltfFile file_of(const nlohmann::json &gltf) {
  const TemporaryFolder folder;
  const auto file = folder.write("scene.gltf", gltf.dump());
  return load_gltf(file, Place{file});
}

inline Scene scene_of(const nlohmann::json &gltf) { return file_of(gltf).at(0).scene; }

inline std::string scene_error_of(const nlohmann::json &gltf) {
  return input_error_of([&] { scene_of(gltf); });
}

} // namespace pmdsim::test
