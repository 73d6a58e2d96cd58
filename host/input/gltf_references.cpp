#include "host/input/gltf_references.h"

#include "host/input/gltf_meshopt.h"

#include <fmt/format.h>

namespace pmdsim {

using nlohmann::json;

namespace {

// An index somewhere in `document` into its array `target`.
class Reference {
public:
  Reference(const json &document, std::string target) : target_(std::move(target)) {
    if (document.contains(target_))
      count_ = document.at(target_).size();
  }

  void check(const json &index, const Place &place) const {
    if (index.get<std::size_t>() >= count_)
      throw input_error(place, fmt::format("index {} into /{}, which has {}", index.dump(), target_, count_));
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
  const Reference nodes(document, "nodes"), meshes(document, "meshes"), scenes(document, "scenes");
  scenes.check_member(document, "scene", root);
  for_each(document, "scenes", root,
           [&](const json &scene, const Place &place) { nodes.check_array(scene, "nodes", place); });
  for_each(document, "nodes", root, [&](const json &node, const Place &place) {
    nodes.check_array(node, "children", place);
    meshes.check_member(node, "mesh", place);
    if (node.contains("matrix") &&
        (node.contains("translation") || node.contains("rotation") || node.contains("scale")))
      throw input_error(place, "expected a matrix or translation, rotation and scale, found both");
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
  for_each(document, "bufferViews", root, [&](const json &view, const Place &place) {
    buffers.check_member(view, "buffer", place);
    if (const json *compressed = meshopt_part(view))
      buffers.check_member(*compressed, "buffer", place / "extensions" / meshopt_extension);
  });
}

} // namespace

void check_references(const json &document, const Place &root) {
  if (!document.value("animations", json::array()).empty())
    throw input_error(root / "animations", "animations are not supported yet");
  check_nodes(document, root);
  check_primitives(document, root);
  check_accessors(document, root);
  check_views(document, root);
}

} // namespace pmdsim
