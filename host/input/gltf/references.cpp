#include "host/input/gltf/document.h"

#include "host/input/gltf/extensions.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <map>
#include <string_view>
#include <utility>

namespace pmdsim {

using nlohmann::json;

namespace {

// Calls visit(value, place) for whatever `path` leads to, "*" being every member of an array or object.
template <class Visit>
void for_each_at(const json &from, std::string_view path, const Place &place, const Visit &visit) {
  if (path.empty()) {
    visit(from, place);
    return;
  }
  const std::string key(path.substr(0, path.find('/')));
  const std::string_view rest = path.substr(std::min(key.size() + 1, path.size()));
  if (key == "*")
    for (const auto &[name, member] : from.items())
      for_each_at(member, rest, place / name, visit);
  else if (from.contains(key))
    for_each_at(from.at(key), rest, place / key, visit);
}

// The indices that `path` leads to from `object`, which is at `place`, into the array `name` of `owner`: of
// the document, or of what is at `owner_place` in it.
void check_indices(const json &object, std::string_view path, const Place &place, const json &owner,
                   const std::string &name, const Place &owner_place = {}) {
  const std::size_t count = owner.contains(name) ? owner.at(name).size() : 0;
  for_each_at(object, path, place, [&](const json &index, const Place &at) {
    if (index.get<std::size_t>() >= count)
      throw input_error(at, fmt::format("index {} into {}, which has {}", index.dump(),
                                        (owner_place / name).pointer.to_string(), count));
  });
}

// The indices of a document into its own arrays.
constexpr std::array<std::pair<std::string_view, const char *>, 21> all_indices{
    {{"scene", "scenes"},
     {"scenes/*/nodes/*", "nodes"},
     {"nodes/*/children/*", "nodes"},
     {"nodes/*/mesh", "meshes"},
     {"nodes/*/skin", "skins"},
     {"skins/*/joints/*", "nodes"},
     {"skins/*/inverseBindMatrices", "accessors"},
     {"animations/*/samplers/*/input", "accessors"},
     {"animations/*/samplers/*/output", "accessors"},
     {"animations/*/channels/*/target/node", "nodes"},
     {"meshes/*/primitives/*/attributes/*", "accessors"},
     {"meshes/*/primitives/*/indices", "accessors"},
     {"meshes/*/primitives/*/material", "materials"},
     {"accessors/*/bufferView", "bufferViews"},
     {"accessors/*/sparse/indices/bufferView", "bufferViews"},
     {"accessors/*/sparse/values/bufferView", "bufferViews"},
     {"materials/*/pbrMetallicRoughness/baseColorTexture/index", "textures"},
     {"textures/*/source", "images"},
     {"textures/*/sampler", "samplers"},
     {"images/*/bufferView", "bufferViews"},
     {"bufferViews/*/buffer", "buffers"}}};

void check_nodes(const json &document, const Place &root) {
  for_each_at(document, "nodes/*", root, [&](const json &node, const Place &place) {
    if (node.contains("skin") && !node.contains("mesh"))
      throw input_error(place / "skin", "expected a mesh beside it");
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
      throw input_error(place, "expected a matrix or translation, rotation and scale, found both");
  });
}

void check_animated_path(const std::string &path, const json &node, std::size_t index, const Place &place) {
  constexpr std::array<std::string_view, 3> supported{"translation", "rotation", "scale"};
  if (path == "weights")
    throw input_error(place, "morph targets are not supported yet, nor their animation");
  if (std::ranges::find(supported, path) == supported.end())
    throw input_error(
        place, fmt::format("expected \"translation\", \"rotation\" or \"scale\", found {}", in_quotes(path)));
  if (node.contains("matrix"))
    throw input_error(
        place, fmt::format("node {} has a matrix, expected none where its {} is animated", index, path));
}

// A channel without a node animates nothing that is known here and is ignored, as glTF says.
void check_animations(const json &document, const Place &root) {
  std::map<std::pair<std::size_t, std::string>, std::string> animated; // node and path: by which channel
  for_each_at(document, "animations/*", root, [&](const json &animation, const Place &animation_place) {
    for_each_at(animation, "channels/*", animation_place, [&](const json &channel, const Place &place) {
      check_indices(channel, "sampler", place, animation, "samplers", animation_place);
      const json &target = channel.at("target");
      if (!target.contains("node"))
        return;
      const auto node = target.at("node").get<std::size_t>();
      const auto path = target.at("path").get<std::string>();
      check_animated_path(path, document.at("nodes").at(node), node, place / "target" / "path");
      const auto [known, is_new] = animated.try_emplace({node, path}, place.pointer.to_string());
      if (!is_new)
        throw input_error(place / "target",
                          fmt::format("the {} of node {} is animated by {} too", path, node, known->second));
    });
  });
}

// Of a file whose accessors may be empty because they are packed, as the end of a message.
std::string remedy_of_packing(const json &document) {
  constexpr const char *draco = "KHR_draco_mesh_compression";
  const json used = document.value("extensionsUsed", json::array());
  return std::ranges::find(used, draco) == used.end() ? ""
                                                      : "; the file is packed with Draco" + remedy_for(draco);
}

// glTF allows indices that are all 0, and tinygltf refuses them without their place.
void check_vertex_indices(const json &document, const Place &root) {
  for_each_at(document, "meshes/*/primitives/*/indices", root, [&](const json &index, const Place &) {
    const auto accessor = index.get<std::size_t>();
    if (!document.at("accessors").at(accessor).contains("bufferView"))
      throw input_error(root / "accessors" / accessor,
                        "missing key \"bufferView\", which indices need" + remedy_of_packing(document));
  });
}

void check_extensions(const json &document, const Place &root) {
  for (const GltfExtension &extension : gltf_extensions())
    for (const ExtensionReference &reference : extension.references)
      for_each_at(document, reference.holder, root, [&](const json &holder, const Place &place) {
        if (const json *part = extension_part(holder, extension.name))
          check_indices(*part, reference.member, place / "extensions" / std::string(extension.name), document,
                        std::string(reference.into));
      });
}

} // namespace

void check_references(const json &document, const Place &root) {
  for (const auto &[path, array] : all_indices)
    check_indices(document, path, root, document, array);
  check_nodes(document, root);
  check_animations(document, root);
  check_vertex_indices(document, root);
  check_extensions(document, root);
}

} // namespace pmdsim
