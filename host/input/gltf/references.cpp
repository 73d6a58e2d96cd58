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

// An array that others refer into: a member of `owner`, the document or what is at `place` in it.
class Array {
public:
  Array(const json &owner, const std::string &name, const Place &place = {})
      : pointer_((place / name).pointer.to_string()) {
    if (owner.contains(name))
      count_ = owner.at(name).size();
  }

  // The indices that `path` leads to from `object`, which is at `place`.
  void check(const json &object, std::string_view path, const Place &place) const {
    for_each_at(object, path, place, [&](const json &index, const Place &at) {
      if (index.get<std::size_t>() >= count_)
        throw input_error(at, fmt::format("index {} into {}, which has {}", index.dump(), pointer_, count_));
    });
  }

private:
  std::string pointer_;
  std::size_t count_ = 0;
};

void check_nodes(const json &document, const Place &root) {
  const Array nodes(document, "nodes"), meshes(document, "meshes"), skins(document, "skins");
  Array(document, "scenes").check(document, "scene", root);
  nodes.check(document, "scenes/*/nodes/*", root);
  for_each_at(document, "nodes/*", root, [&](const json &node, const Place &place) {
    nodes.check(node, "children/*", place);
    meshes.check(node, "mesh", place);
    skins.check(node, "skin", place);
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
  const Array nodes(document, "nodes"), accessors(document, "accessors");
  std::map<std::pair<std::size_t, std::string>, std::string> animated; // node and path: by which channel
  for_each_at(document, "animations/*", root, [&](const json &animation, const Place &animation_place) {
    const Array samplers(animation, "samplers", animation_place);
    for_each_at(animation, "samplers/*", animation_place, [&](const json &sampler, const Place &place) {
      accessors.check(sampler, "input", place);
      accessors.check(sampler, "output", place);
    });
    for_each_at(animation, "channels/*", animation_place, [&](const json &channel, const Place &place) {
      samplers.check(channel, "sampler", place);
      nodes.check(channel, "target/node", place);
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

void check_primitives(const json &document, const Place &root) {
  const Array accessors(document, "accessors"), materials(document, "materials");
  for_each_at(document, "meshes/*/primitives/*", root, [&](const json &primitive, const Place &place) {
    accessors.check(primitive, "attributes/*", place);
    accessors.check(primitive, "indices", place);
    // glTF allows indices that are all 0, and tinygltf refuses them without their place.
    for_each_at(primitive, "indices", place, [&](const json &index, const Place &) {
      const auto accessor = index.get<std::size_t>();
      if (!document.at("accessors").at(accessor).contains("bufferView"))
        throw input_error(root / "accessors" / accessor, "missing key \"bufferView\", which indices need");
    });
    materials.check(primitive, "material", place);
  });
}

// Members of the objects that `objects` leads to, paths too, and the arrays of the document that they index.
struct Indices {
  std::string_view objects;
  std::vector<std::pair<std::string_view, const char *>> members;
};

void check_indices(const json &document, const std::vector<Indices> &rows, const Place &root) {
  for (const Indices &row : rows)
    for_each_at(document, row.objects, root, [&](const json &object, const Place &place) {
      for (const auto &[path, array] : row.members)
        Array(document, array).check(object, path, place);
    });
}

void check_extensions(const json &document, const Place &root) {
  for (const GltfExtension &extension : gltf_extensions())
    for (const ExtensionReference &reference : extension.references)
      for_each_at(document, reference.holder, root, [&](const json &holder, const Place &place) {
        if (const json *part = extension_part(holder, extension.name))
          Array(document, std::string(reference.into))
              .check(*part, reference.member, place / "extensions" / std::string(extension.name));
      });
}

} // namespace

void check_references(const json &document, const Place &root) {
  check_nodes(document, root);
  check_indices(document, {{"skins/*", {{"joints/*", "nodes"}, {"inverseBindMatrices", "accessors"}}}}, root);
  check_animations(document, root);
  check_primitives(document, root);
  check_indices(document,
                {{"accessors/*",
                  {{"bufferView", "bufferViews"},
                   {"sparse/indices/bufferView", "bufferViews"},
                   {"sparse/values/bufferView", "bufferViews"}}},
                 {"materials/*", {{"pbrMetallicRoughness/baseColorTexture/index", "textures"}}},
                 {"textures/*", {{"source", "images"}, {"sampler", "samplers"}}},
                 {"images/*", {{"bufferView", "bufferViews"}}},
                 {"bufferViews/*", {{"buffer", "buffers"}}}},
                root);
  check_extensions(document, root);
}

} // namespace pmdsim
