#include "host/input/gltf/references.h"

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

// An index into the array `target` of `owner`, the document or what is at `place` in it.
class Reference {
public:
  Reference(const json &owner, const std::string &target, const Place &place = {})
      : target_((place / target).pointer.to_string()) {
    if (owner.contains(target))
      count_ = owner.at(target).size();
  }

  void check(const json &index, const Place &place) const {
    if (index.get<std::size_t>() >= count_)
      throw input_error(place, fmt::format("index {} into {}, which has {}", index.dump(), target_, count_));
  }

  void check_member(const json &object, const std::string &key, const Place &place) const {
    if (object.contains(key))
      check(object.at(key), place / key);
  }

  void check_array(const json &object, const std::string &key, const Place &place) const {
    if (!object.contains(key))
      return;
    const json &indices = object.at(key);
    for (std::size_t i = 0; i < indices.size(); ++i)
      check(indices[i], place / key / i);
  }

private:
  std::string target_;
  std::size_t count_ = 0;
};

// Calls visit(element, place) for every element of an array that may be absent.
template <class Visit>
void for_each(const json &object, const std::string &key, const Place &place, Visit visit) {
  if (!object.contains(key))
    return;
  const json &elements = object.at(key);
  for (std::size_t i = 0; i < elements.size(); ++i)
    visit(elements[i], place / key / i);
}

void check_nodes(const json &document, const Place &root) {
  const Reference nodes(document, "nodes"), meshes(document, "meshes"), scenes(document, "scenes"),
      skins(document, "skins");
  scenes.check_member(document, "scene", root);
  for_each(document, "scenes", root,
           [&](const json &scene, const Place &place) { nodes.check_array(scene, "nodes", place); });
  for_each(document, "nodes", root, [&](const json &node, const Place &place) {
    nodes.check_array(node, "children", place);
    meshes.check_member(node, "mesh", place);
    skins.check_member(node, "skin", place);
    if (node.contains("skin") && !node.contains("mesh"))
      throw input_error(place / "skin", "expected a mesh beside it");
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
      throw input_error(place, "expected a matrix or translation, rotation and scale, found both");
  });
}

void check_skins(const json &document, const Place &root) {
  const Reference nodes(document, "nodes"), accessors(document, "accessors");
  for_each(document, "skins", root, [&](const json &skin, const Place &place) {
    nodes.check_array(skin, "joints", place);
    accessors.check_member(skin, "inverseBindMatrices", place);
  });
}

void check_animated_path(const std::string &path, const json &node, std::size_t index, const Place &place) {
  constexpr std::array<std::string_view, 3> supported{"translation", "rotation", "scale"};
  if (path == "weights")
    throw input_error(place, "morph targets are not supported yet, nor their animation");
  if (std::find(supported.begin(), supported.end(), path) == supported.end())
    throw input_error(
        place, fmt::format("expected \"translation\", \"rotation\" or \"scale\", found {}", in_quotes(path)));
  if (node.contains("matrix"))
    throw input_error(
        place, fmt::format("node {} has a matrix, expected none where its {} is animated", index, path));
}

// A channel without a node animates nothing that is known here and is ignored, as glTF says.
void check_animations(const json &document, const Place &root) {
  const Reference nodes(document, "nodes"), accessors(document, "accessors");
  std::map<std::pair<std::size_t, std::string>, std::string> animated; // node and path: by which channel
  for_each(document, "animations", root, [&](const json &animation, const Place &animation_place) {
    const Reference samplers(animation, "samplers", animation_place);
    for_each(animation, "samplers", animation_place, [&](const json &sampler, const Place &place) {
      accessors.check_member(sampler, "input", place);
      accessors.check_member(sampler, "output", place);
    });
    for_each(animation, "channels", animation_place, [&](const json &channel, const Place &place) {
      samplers.check_member(channel, "sampler", place);
      const json &target = channel.at("target");
      nodes.check_member(target, "node", place / "target");
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

// glTF allows indices that are all 0, and tinygltf refuses them without their place.
void refuse_zero_indices(const json &document, const json &primitive, const Place &place) {
  if (!primitive.contains("indices"))
    return;
  const auto accessor = primitive.at("indices").get<std::size_t>();
  if (!document.at("accessors").at(accessor).contains("bufferView"))
    throw input_error(Place{place.file} / "accessors" / accessor,
                      "missing key \"bufferView\", which indices need");
}

void check_primitives(const json &document, const Place &root) {
  const Reference accessors(document, "accessors"), materials(document, "materials");
  for_each(document, "meshes", root, [&](const json &mesh, const Place &mesh_place) {
    for_each(mesh, "primitives", mesh_place, [&](const json &primitive, const Place &place) {
      for (const auto &[name, accessor] : primitive.at("attributes").items())
        accessors.check(accessor, place / "attributes" / name);
      accessors.check_member(primitive, "indices", place);
      refuse_zero_indices(document, primitive, place);
      materials.check_member(primitive, "material", place);
    });
  });
}

void check_accessors(const json &document, const Place &root) {
  const Reference views(document, "bufferViews");
  for_each(document, "accessors", root, [&](const json &accessor, const Place &place) {
    views.check_member(accessor, "bufferView", place);
    if (!accessor.contains("sparse"))
      return;
    for (const char *part : {"indices", "values"})
      views.check_member(accessor.at("sparse").at(part), "bufferView", place / "sparse" / part);
  });
}

void check_views(const json &document, const Place &root) {
  const Reference buffers(document, "buffers");
  for_each(document, "bufferViews", root,
           [&](const json &view, const Place &place) { buffers.check_member(view, "buffer", place); });
}

void check_textures(const json &document, const Place &root) {
  const Reference textures(document, "textures"), images(document, "images"), samplers(document, "samplers"),
      views(document, "bufferViews");
  const json::json_pointer base_texture("/pbrMetallicRoughness/baseColorTexture");
  for_each(document, "materials", root, [&](const json &material, const Place &place) {
    if (material.contains(base_texture))
      textures.check_member(material.at(base_texture), "index",
                            place / "pbrMetallicRoughness" / "baseColorTexture");
  });
  for_each(document, "textures", root, [&](const json &texture, const Place &place) {
    images.check_member(texture, "source", place);
    samplers.check_member(texture, "sampler", place);
  });
  for_each(document, "images", root,
           [&](const json &image, const Place &place) { views.check_member(image, "bufferView", place); });
}

// Calls visit(value, place) for whatever `path` leads to, "*" being every element of an array.
template <class Visit>
void for_each_at(const json &from, std::string_view path, const Place &place, const Visit &visit) {
  if (path.empty()) {
    visit(from, place);
    return;
  }
  const std::string key(path.substr(0, path.find('/')));
  const std::string_view rest = path.substr(std::min(key.size() + 1, path.size()));
  if (key == "*")
    for (std::size_t i = 0; i < from.size(); ++i)
      for_each_at(from[i], rest, place / i, visit);
  else if (from.contains(key))
    for_each_at(from.at(key), rest, place / key, visit);
}

void check_extensions(const json &document, const Place &root) {
  for (const GltfExtension &extension : gltf_extensions())
    for (const ExtensionReference &reference : extension.references) {
      const Reference target(document, std::string(reference.into));
      for_each_at(document, reference.holder, root, [&](const json &holder, const Place &place) {
        if (const json *part = extension_part(holder, extension.name))
          for_each_at(*part, reference.member, place / "extensions" / std::string(extension.name),
                      [&](const json &index, const Place &at) { target.check(index, at); });
      });
    }
}

} // namespace

void check_references(const json &document, const Place &root) {
  check_nodes(document, root);
  check_skins(document, root);
  check_animations(document, root);
  check_primitives(document, root);
  check_accessors(document, root);
  check_textures(document, root);
  check_views(document, root);
  check_extensions(document, root);
}

} // namespace pmdsim
