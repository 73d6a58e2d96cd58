#pragma once
// glTF 2.0 scenes, .gltf and .glb, over time: triangles in the world frame and the named nodes that poses
// refer to.

#include "engine/model/scene.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/animation.h"
#include "host/input/gltf/cameras.h"
#include "host/input/gltf/document.h"
#include "host/input/gltf/ignored_features.h"
#include "host/input/gltf/nodes.h"
#include "host/input/gltf/skin.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
}

namespace pmdsim {

class GltfMaterials;

struct NamedNode {
  std::string name;
  AffineTransform world_from_node;
  std::string mesh{}; // the name of its mesh, if it has one
  bool is_camera = false;
  std::optional<GltfPerspective> camera{}; // where it is one with a perspective
};

// Where a named node is put: NodePlacement.
struct PlacedNode {
  std::string name;
  Pose world_from_node;
  Place place;
};

// A file's active scene at one time.
struct GltfScene {
  std::filesystem::path file;
  Scene scene;                  // may be empty
  std::vector<NamedNode> nodes; // those of the active scene that have a name, parents first
};

// A file, read and checked once.
class GltfFile {
public:
  // Throws Error (input).
  GltfFile(std::filesystem::path file, std::shared_ptr<const tinygltf::Model> model,
           std::shared_ptr<GltfMaterials> materials, const nlohmann::json &document);

  const std::filesystem::path &file() const { return file_; }
  // Whether any node of the active scene is animated.
  bool moves() const;
  // What it asks for that is not simulated; cameras and lights as far as no pose is at their nodes, of which
  // `used` are the names.
  std::vector<Warning> warnings(const std::vector<std::string> &used) const;
  // At any finite time, before 0 too, with some nodes put elsewhere. Throws Error (input): also where a node
  // to be put is not there, or more than once.
  GltfScene at(double time_s, const std::vector<PlacedNode> &placed = {}) const;

private:
  std::vector<NamedNode> named_nodes() const; // without their transforms
  std::optional<GltfPerspective> camera_of(int index) const;
  std::vector<NodePlacement> placements(const std::vector<PlacedNode> &placed) const;

  std::filesystem::path file_;
  std::shared_ptr<const tinygltf::Model> model_;
  std::shared_ptr<GltfMaterials> materials_; // decodes textures at the first use
  std::vector<SceneNode> nodes_;             // of the active scene, where nothing animates them
  Animation animation_;
  Skins skins_;
  std::vector<std::optional<GltfPerspective>> cameras_; // of the file
  IgnoredFeatures ignored_;
};

// That a file has no such node, and which was meant or which there are.
std::string absent_node_text(const std::string &name, const std::filesystem::path &file,
                             const std::vector<NamedNode> &nodes);

// The same where a camera was asked for: a file without one is told how it gets one, or how to do without.
std::string absent_camera_text(const std::string &name, const std::filesystem::path &file,
                               const std::vector<NamedNode> &nodes);

// Throws Error (input): an error in the file is told at its place there ("scene.gltf: /accessors/3: ..."), a
// file that cannot be read at `named_at`, the place that names it. Features of glTF without which the scene
// would be another are refused by name; the others that are not simulated are warned of.
GltfFile load_gltf(const std::filesystem::path &file, const Place &named_at,
                   UriFiles files = UriFiles::beside);

} // namespace pmdsim
