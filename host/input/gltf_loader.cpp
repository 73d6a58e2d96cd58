#include "host/input/gltf_loader.h"

#include "host/input/gltf_buffers.h"
#include "host/input/gltf_document.h"
#include "host/input/gltf_material.h"
#include "host/input/gltf_mesh.h"
#include "host/input/gltf_meshopt.h"

#include <fmt/format.h>
#include <map>
#include <tiny_gltf.h>
#include <utility>

namespace pmdsim {

using nlohmann::json;

namespace {

// tinygltf opens whatever a file names and decodes every image, so it is given only the parts that name no
// file.
std::string without_files(const json &document) {
  json kept = json::object();
  for (const char *key : {"asset", "extensionsUsed", "extensionsRequired", "scene", "scenes", "nodes",
                          "meshes", "materials", "accessors", "bufferViews"})
    if (document.contains(key))
      kept[key] = document.at(key);
  return kept.dump();
}

// Gives each decoded view a buffer of its own.
void replace_views(std::vector<DecodedView> &decoded, tinygltf::Model &model) {
  for (DecodedView &view : decoded) {
    model.bufferViews[view.view].buffer = static_cast<int>(model.buffers.size());
    model.bufferViews[view.view].byteOffset = 0;
    model.buffers.emplace_back().data = std::move(view.bytes);
  }
}

tinygltf::Model read_model(const std::filesystem::path &file, const Place &named_at) {
  const GltfDocument document = read_gltf_document(file, named_at);
  const std::string text = without_files(document.json);
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
  tinygltf::Model model;
  std::string error, warning;
  if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                  ""))
    throw input_error(Place{file}, "no valid glTF 2.0: " + error);
  std::vector<Bytes> buffers = read_gltf_buffers(document, file);
  std::vector<DecodedView> decoded = decode_meshopt_views(document.json, buffers, Place{file});
  for (Bytes &bytes : buffers)
    model.buffers.emplace_back().data = std::move(bytes);
  replace_views(decoded, model);
  return model;
}

struct UsedMaterial {
  GltfMaterial material;
  std::uint32_t surface; // index into Scene::surfaces
};

// The scene's surfaces, made as they are used. Where vertices have colours, a material is another surface.
class Surfaces {
public:
  Surfaces(const tinygltf::Model &model, const Place &root, Scene &scene)
      : model_(model), root_(root), scene_(scene) {}

  const UsedMaterial &operator[](const tinygltf::Primitive &primitive) {
    const std::pair key(primitive.material, primitive.attributes.contains("COLOR_0"));
    const auto known = used_.find(key);
    if (known != used_.end())
      return known->second;
    const UsedMaterial made{made_of(key.first, key.second),
                            static_cast<std::uint32_t>(scene_.surfaces.size())};
    scene_.surfaces.push_back(made.material.surface);
    return used_.emplace(key, made).first->second;
  }

private:
  // Index -1 is glTF's default material, white and single-sided.
  GltfMaterial made_of(int material, bool vertex_colours) const {
    if (material < 0)
      return material_of(tinygltf::Material{}, root_, vertex_colours);
    const auto index = static_cast<std::size_t>(material);
    return material_of(model_.materials[index], root_ / "materials" / index, vertex_colours);
  }

  const tinygltf::Model &model_;
  const Place &root_;
  Scene &scene_;
  std::map<std::pair<int, bool>, UsedMaterial> used_;
};

void append_object(const tinygltf::Model &model, const SceneNode &scene_node, const Place &root,
                   Surfaces &surfaces, Scene &scene) {
  const tinygltf::Node &node = model.nodes[scene_node.index];
  if (node.skin >= 0)
    throw input_error(root / "nodes" / scene_node.index / "skin", "skins are not supported yet");
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.objects.push_back(node.name.empty() ? fmt::format("node {}", scene_node.index) : node.name);
  const auto mesh = static_cast<std::size_t>(node.mesh);
  const std::vector<tinygltf::Primitive> &primitives = model.meshes[mesh].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const UsedMaterial &used = surfaces[primitives[i]];
    append_primitive(model, primitives[i], scene_node.world_from_node, used.material, used.surface, object,
                     root / "meshes" / mesh / "primitives" / i, scene);
  }
}

} // namespace

GltfFile::GltfFile(std::filesystem::path file, std::shared_ptr<const tinygltf::Model> model)
    : file_(std::move(file)), model_(std::move(model)) {}

bool GltfFile::moves() const { return false; }

GltfScene GltfFile::at(double) const {
  const Place root{file_};
  GltfScene result{file_, {}, {}};
  Surfaces surfaces(*model_, root, result.scene);
  for (const SceneNode &scene_node : active_nodes(*model_, root)) {
    const tinygltf::Node &node = model_->nodes[scene_node.index];
    if (!node.name.empty())
      result.nodes.push_back({node.name, scene_node.world_from_node});
    if (node.mesh >= 0)
      append_object(*model_, scene_node, root, surfaces, result.scene);
  }
  return result;
}

GltfFile load_gltf(const std::filesystem::path &file, const Place &named_at) {
  return {file, std::make_shared<const tinygltf::Model>(read_model(file, named_at))};
}

} // namespace pmdsim
