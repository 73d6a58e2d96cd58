#include "host/input/gltf/loader.h"

#include "host/input/file/memory_request.h"
#include "host/input/gltf/data/buffers.h"
#include "host/input/gltf/data/meshopt.h"
#include "host/input/gltf/document.h"
#include "host/input/gltf/material/material.h"
#include "host/input/gltf/mesh/mesh.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <map>
#include <new>
#include <string_view>
#include <tiny_gltf.h>
#include <utility>

namespace pmdsim {

using nlohmann::json;

namespace {

// A copy without what others have added, at any depth; depths are limited.
json without_additions(const json &value) {
  if (!value.is_structured())
    return value;
  json kept(value.type());
  for (const auto &[key, each] : value.items())
    if (value.is_array())
      kept.push_back(without_additions(each));
    else if (key != "extras" && key != "extensions")
      kept[key] = without_additions(each);
  return kept;
}

// tinygltf opens whatever a file names and decodes every image, so it is given only the parts that name no
// file. What others have added takes many times its text there, and is read from the document itself.
std::string core_of(const json &document) {
  json kept = json::object();
  for (const char *key : {"asset", "extensionsUsed", "extensionsRequired", "scene", "scenes", "nodes",
                          "meshes", "accessors", "bufferViews", "animations", "skins"})
    if (document.contains(key))
      kept[key] = without_additions(document.at(key));
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

// tinygltf's structs are much larger than their text may be.
void require_room_for_model(const json &document, const std::filesystem::path &file) {
  constexpr std::size_t struct_bytes = 1024; // about
  std::size_t bytes = 0;
  for (const char *key : {"nodes", "meshes", "accessors", "bufferViews", "animations", "skins"})
    bytes += list_at(document, key).size() * struct_bytes;
  for (const json &mesh : list_at(document, "meshes"))
    bytes += list_at(mesh, "primitives").size() * struct_bytes;
  for (const json &animation : list_at(document, "animations"))
    bytes += (list_at(animation, "channels").size() + list_at(animation, "samplers").size()) * struct_bytes;
  require_memory(bytes, Place{file}, "a model of its lists");
}

tinygltf::Model model_of(const GltfDocument &document, const std::filesystem::path &file) {
  require_room_for_model(document.json, file);
  const std::string text = core_of(document.json);
  tinygltf::TinyGLTF parser;
  parser.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
  tinygltf::Model model;
  std::string error, warning;
  if (!parser.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()),
                                  "")) {
    if (error.find(std::bad_alloc().what()) != error.npos) // which it catches as any other
      throw std::bad_alloc();
    throw input_error(Place{file}, "no valid glTF 2.0: " + error);
  }
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
  Surfaces(GltfMaterials &materials, Scene &scene) : materials_(materials), scene_(scene) {}

  const UsedMaterial &operator[](const tinygltf::Primitive &primitive) {
    const std::pair key(primitive.material, primitive.attributes.contains("COLOR_0"));
    const auto known = used_.find(key);
    if (known != used_.end())
      return known->second;
    const UsedMaterial made{materials_.material_of(key.first, key.second),
                            static_cast<std::uint32_t>(scene_.surfaces.size())};
    scene_.surfaces.push_back(made.material.surface);
    return used_.emplace(key, made).first->second;
  }

private:
  GltfMaterials &materials_;
  Scene &scene_;
  std::map<std::pair<int, bool>, UsedMaterial> used_;
};

// The node that names each of `nodes`, parents first: itself or the nearest one above that has a name, for
// packers hang meshes on children without.
std::vector<std::size_t> naming_nodes(const tinygltf::Model &model, const std::vector<SceneNode> &nodes) {
  std::vector<std::size_t> naming(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    naming[i] = model.nodes[nodes[i].index].name.empty() && nodes[i].parent ? naming[*nodes[i].parent] : i;
  return naming;
}

std::string object_name(const tinygltf::Model &model, const SceneNode &naming) {
  const std::string &name = model.nodes[naming.index].name;
  return name.empty() ? fmt::format("node {}", naming.index) : name;
}

std::string mesh_name(const tinygltf::Model &model, const tinygltf::Node &node) {
  return node.mesh < 0 ? "" : model.meshes[static_cast<std::size_t>(node.mesh)].name;
}

// `placement_of` gives that of each of the mesh's primitives.
template <class PlacementOf>
void append_object(const tinygltf::Model &model, std::size_t mesh, const std::string &name,
                   PlacementOf placement_of, const Place &root, Surfaces &surfaces, std::size_t &shapes,
                   Scene &scene) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.objects.push_back(name);
  const std::vector<tinygltf::Primitive> &primitives = model.meshes[mesh].primitives;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const UsedMaterial &used = surfaces[primitives[i]];
    const GltfPrimitive primitive{model, primitives[i], root / "meshes" / mesh / "primitives" / i};
    append_primitive(primitive, {placement_of(i), used.material, used.surface, object}, shapes, scene);
  }
}

std::vector<std::string> names_of(const std::vector<NamedNode> &nodes) {
  std::vector<std::string> names;
  std::ranges::transform(nodes, std::back_inserter(names), &NamedNode::name);
  return names;
}

// Which node may have been meant, as the end of a message; empty where none is near.
std::string node_meant(const std::string &name, const std::vector<NamedNode> &nodes) {
  const auto of_mesh = std::ranges::find(nodes, name, &NamedNode::mesh);
  return of_mesh == nodes.end() ? did_you_mean(name, names_of(nodes))
                                : fmt::format("; it is the mesh of the node {}", in_quotes(of_mesh->name));
}

std::vector<std::size_t> indices_of(const std::vector<SceneNode> &nodes) {
  std::vector<std::size_t> indices;
  std::ranges::transform(nodes, std::back_inserter(indices), &SceneNode::index);
  return indices;
}

} // namespace

GltfFile::GltfFile(std::filesystem::path file, std::shared_ptr<const tinygltf::Model> model,
                   std::shared_ptr<GltfMaterials> materials, const json &document)
    : file_(std::move(file)), model_(std::move(model)), materials_(std::move(materials)),
      nodes_(active_nodes(*model_, Place{file_})), animation_(read_animation(*model_, nodes_, Place{file_})),
      skins_(read_skins(*model_, nodes_, Place{file_})), cameras_(gltf_cameras(document)),
      ignored_(ignored_features(document, indices_of(nodes_), Place{file_})) {}

bool GltfFile::moves() const { return animation_.moves(); }

std::vector<Warning> GltfFile::warnings(const std::vector<std::string> &used) const {
  std::vector<Warning> all = ignored_.warnings;
  std::ranges::copy(unused_carriers(ignored_, used), std::back_inserter(all));
  return all;
}

std::vector<NamedNode> GltfFile::named_nodes() const {
  std::vector<NamedNode> named;
  for (const SceneNode &node : nodes_)
    if (const tinygltf::Node &of = model_->nodes[node.index]; !of.name.empty())
      named.push_back({of.name, {}, mesh_name(*model_, of)});
  return named;
}

std::optional<GltfPerspective> GltfFile::camera_of(int index) const {
  const auto camera = static_cast<std::size_t>(index);
  return index >= 0 && camera < cameras_.size() ? cameras_[camera] : std::nullopt;
}

std::vector<NodePlacement> GltfFile::placements(const std::vector<PlacedNode> &placed) const {
  std::vector<NodePlacement> result;
  if (placed.empty())
    return result;
  std::multimap<std::string_view, std::size_t> places;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    places.emplace(model_->nodes[nodes_[i].index].name, i);
  for (const PlacedNode &each : placed) {
    const auto [node, end] = places.equal_range(each.name);
    if (node == end)
      throw input_error(each.place, absent_node_text(each.name, file_, named_nodes()));
    if (std::next(node) != end)
      throw input_error(each.place,
                        fmt::format("more than one node {} in {}", in_quotes(each.name), file_.string()));
    result.push_back({node->second, each.world_from_node, each.place});
  }
  return result;
}

GltfScene GltfFile::at(double time_s, const std::vector<PlacedNode> &placed) const {
  const Place root{file_};
  std::vector<SceneNode> nodes = nodes_;
  animation_.apply(time_s, nodes);
  const std::vector<AffineTransform> world_from = world_from_nodes(nodes, root, placements(placed));
  std::map<int, std::vector<AffineTransform>> world_from_skin; // by skin, then joint
  for (const auto &[skin, joints] : skins_.joints)
    world_from_skin[skin] = world_from_mesh_by_joint(joints, world_from);

  GltfScene result{file_, {}, {}};
  const std::vector<std::size_t> naming = naming_nodes(*model_, nodes);
  Surfaces surfaces(*materials_, result.scene);
  std::size_t shapes = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const tinygltf::Node &node = model_->nodes[nodes[i].index];
    const auto placement_of = [&](std::size_t primitive) {
      return node.skin < 0
                 ? Placement(world_from[i])
                 : Placement(skins_.weights.at({node.mesh, primitive}), world_from_skin.at(node.skin));
    };
    if (!node.name.empty())
      result.nodes.push_back(
          {node.name, world_from[i], mesh_name(*model_, node), node.camera >= 0, camera_of(node.camera)});
    if (node.mesh >= 0)
      append_object(*model_, static_cast<std::size_t>(node.mesh), object_name(*model_, nodes[naming[i]]),
                    placement_of, root, surfaces, shapes, result.scene);
  }
  return result;
}

std::string absent_node_text(const std::string &name, const std::filesystem::path &file,
                             const std::vector<NamedNode> &nodes) {
  const std::string text = fmt::format("no node {} in {}", in_quotes(name), file.string());
  if (nodes.empty())
    return text + ", whose nodes have no names";
  if (const std::string meant = node_meant(name, nodes); !meant.empty())
    return text + meant;
  return text + "; expected " + listed_names(names_of(nodes));
}

std::string absent_camera_text(const std::string &name, const std::filesystem::path &file,
                               const std::vector<NamedNode> &nodes) {
  if (std::ranges::any_of(nodes, &NamedNode::is_camera) || !node_meant(name, nodes).empty())
    return absent_node_text(name, file, nodes);
  const std::string others = nodes.empty() ? "" : "; its nodes are " + listed_names(names_of(nodes), " and ");
  return fmt::format("no node {} in {}, which has no camera that a pose can name: export it with its cameras "
                     "(Blender: Include, Cameras), or give position_m and look_at_m{}",
                     in_quotes(name), file.string(), others);
}

GltfFile load_gltf(const std::filesystem::path &file, const Place &named_at, UriFiles files) {
  GltfDocument document = read_gltf_document(file, named_at);
  document.files = files;
  const auto model = std::make_shared<const tinygltf::Model>(model_of(document, file));
  return {file, model, std::make_shared<GltfMaterials>(document.json, model, file, files), document.json};
}

} // namespace pmdsim
