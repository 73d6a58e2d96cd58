#pragma once
// glTF 2.0 scenes, .gltf and .glb: triangles in the world frame and the named nodes that poses refer to.

#include "engine/scene.h"
#include "host/input/gltf_nodes.h"
#include "host/input/input_error.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pmdsim {

struct NamedNode {
  std::string name;
  AffineTransform world_from_node;
};

struct GltfScene {
  std::filesystem::path file;
  Scene scene;                  // may be empty
  std::vector<NamedNode> nodes; // those of the active scene that have a name, parents first
};

// Throws Error (input): what is wrong in the file is told at its place there ("scene.gltf: /accessors/3:
// ..."), a file that cannot be read at `named_at`, the place that names it. What glTF can say and the
// simulator cannot yet do is refused by name, never ignored.
GltfScene load_gltf(const std::filesystem::path &file, const Place &named_at);

} // namespace pmdsim
