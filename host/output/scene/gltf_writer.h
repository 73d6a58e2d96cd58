#pragma once
// A scene as a glTF 2.0 file, so that this program and others can read it.

#include "engine/model/scene.h"
#include "host/output/files/output_set.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// What a node's camera sees, for programs that show scenes; pmdsim reads the node's place alone.
struct GltfCamera {
  double vertical_view_rad; // the whole angle, above 0 and below pi
  double aspect;            // width over height
};

struct GltfNode {
  std::string name{}; // empty: none
  // Its frame in its parent's, of the topmost nodes in the world: right-handed, +Y up; a camera looks along
  // -Z.
  glm::dvec3 position_m{0.0};
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0}; // a unit quaternion
  std::vector<std::uint32_t> surfaces{};   // the scene's triangles of these are its mesh, in its frame
  std::optional<GltfCamera> camera{};
  std::vector<GltfNode> children{};
};

// Adds NAME.gltf, text that people can change, and NAME.bin, its numbers. A surface becomes a material of the
// name of its object, whose base colour is grey and as bright as the surface is reflective. Positions are
// rounded to float32. The scene has triangles on each of the nodes' surfaces, and no discs or paint. Throws
// Error (output).
void add_gltf(OutputSet &files, const std::string &name, const Scene &scene,
              const std::vector<GltfNode> &nodes);

} // namespace pmdsim
