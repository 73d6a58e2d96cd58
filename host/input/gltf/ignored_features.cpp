#include "host/input/gltf/ignored_features.h"

#include "host/input/gltf/document.h"
#include "host/input/gltf/extensions.h"
#include "host/input/gltf/material/ignored_optics.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>
#include <string_view>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr std::size_t most_named = 5;

// Extensions about which nothing is told by their name alone: what they ask for is told otherwise, or has no
// effect on a measurement (other images and compressed copies of what the file has in plain form, too, and
// words about the file).
constexpr std::array silent_extensions{
    "EXT_mesh_gpu_instancing",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
};

const json *extension_of(const json &object, const char *name) {
  if (!object.is_object() || !object.contains("extensions") || !object.at("extensions").is_object())
    return nullptr;
  const json &extensions = object.at("extensions");
  const auto part = extensions.find(name);
  return part == extensions.end() ? nullptr : &*part;
}

std::string name_of(const json &object, std::size_t index) {
  const auto name = object.find("name");
  const bool has_name =
      name != object.end() && name->is_string() && !name->get_ref<const std::string &>().empty();
  return has_name ? in_quotes(name->get<std::string>()) : fmt::format("number {}", index);
}

// "\"brass\", \"steel\" and 3 more".
std::string names_of(const json &list, const std::vector<std::size_t> &found) {
  std::vector<std::string> names;
  for (const std::size_t index : found)
    if (names.size() < most_named)
      names.push_back(name_of(list.at(index), index));
  const std::string others =
      found.size() > names.size() ? fmt::format(" and {} more", found.size() - names.size()) : "";
  return fmt::format("{}{}", fmt::join(names, ", "), others);
}

// "2 of 7 nodes have a light (...)", of a list that any of `found` are in.
std::string counted(const json &list, const std::vector<std::size_t> &found, std::size_t all,
                    std::string_view what, std::string_view one, std::string_view many) {
  return fmt::format("{} of {} {}{} {} ({})", found.size(), all, what, all == 1 ? "" : "s",
                     found.size() == 1 ? one : many, names_of(list, found));
}

class Features {
public:
  Features(const json &document, const std::vector<std::size_t> &nodes, const Place &root)
      : document_(document), nodes_(nodes), root_(root) {
    for (const std::size_t node : nodes)
      if (list_at(document, "nodes").at(node).contains("mesh"))
        meshes_.insert(list_at(document, "nodes").at(node).at("mesh").get<std::size_t>());
    for (const std::size_t mesh : meshes_)
      for (const json &primitive : list_at(document, "meshes").at(mesh).at("primitives"))
        if (primitive.contains("material"))
          materials_.insert(primitive.at("material").get<std::size_t>());
  }

  IgnoredFeatures found() {
    add_materials();
    add_extras();
    add_nodes();
    add_vertex_colours();
    add_variants();
    add_animation_pointers();
    add_scenes();
    add_extensions();
    return std::move(result_);
  }

private:
  void add(const char *code, const Place &place, const std::string &text) {
    result_.warnings.push_back(input_warning(code, place, text));
  }

  void add_materials() {
    const json &materials = list_at(document_, "materials");
    const json::json_pointer place("/asset/generator");
    const bool is_told = document_.contains(place) && document_.at(place).is_string();
    const std::string generator = is_told ? document_.at(place).get<std::string>() : "";
    std::map<std::size_t, json> meant;
    for (const std::size_t i : materials_)
      meant[i] = as_meant(materials.at(i), generator);
    for (const IgnoredOptics &optics : ignored_optics()) {
      std::vector<std::size_t> found;
      std::ranges::copy_if(materials_, std::back_inserter(found),
                           [&](std::size_t i) { return optics.is_shown(meant.at(i)); });
      if (!found.empty())
        add(optics.code, root_ / "materials" / found.front(),
            fmt::format("{}, which is ignored: {}",
                        counted(materials, found, materials_.size(), "material", optics.one, optics.many),
                        optics.instead));
    }
  }

  // Keys of ours that are misspelt, or elsewhere than in a material.
  void add_extras() {
    constexpr std::string_view ours = "pmdsim";
    constexpr std::array<std::string_view, 2> known{"pmdsim_reflectivity", "pmdsim_point_area_m2"};
    for (const char *list : {"materials", "nodes", "meshes"}) {
      const json &elements = list_at(document_, list);
      for (std::size_t i = 0; i < elements.size(); ++i) {
        const json extras = elements.at(i).is_object() ? elements.at(i).value("extras", json()) : json();
        if (!extras.is_object())
          continue;
        for (const auto &[key, value] : extras.items())
          if (key.starts_with(ours) &&
              (std::string_view(list) != "materials" || std::ranges::find(known, key) == known.end()))
            add(warning_code("gltf-extras"), root_ / list / i / "extras" / key,
                fmt::format("it means nothing there; \"{}\" in the extras of a material are read",
                            fmt::join(known, "\" and \"")));
      }
    }
  }

  // `has` of a node that is an object.
  template <class Has>
  void add_of_nodes(const char *code, const Has &has, const char *one, const char *many,
                    const char *instead) {
    const json &nodes = list_at(document_, "nodes");
    std::vector<std::size_t> found;
    std::ranges::copy_if(nodes_, std::back_inserter(found), [&](std::size_t i) { return has(nodes.at(i)); });
    if (!found.empty())
      add(code, root_ / "nodes" / found.front(),
          fmt::format("{}, which is ignored: {}", counted(nodes, found, nodes_.size(), "node", one, many),
                      instead));
  }

  void add_nodes() {
    add_of_nodes(
        warning_code("gltf-instancing"),
        [](const json &node) { return extension_of(node, "EXT_mesh_gpu_instancing") != nullptr; },
        "is drawn many times", "are drawn many times",
        "each is there once, where its node is; write the instances as nodes");
    add_of_nodes(
        warning_code("gltf-visibility"),
        [](const json &node) {
          const json *part = extension_of(node, "KHR_node_visibility");
          return part != nullptr && part->is_object() && part->contains("visible") &&
                 part->at("visible") == false;
        },
        "is hidden", "are hidden", "what hangs on them is seen and blocks light; leave it out of the scene");
    for (const std::size_t i : nodes_) {
      const json &node = list_at(document_, "nodes").at(i);
      const GltfCarrier carrier{node.value("name", ""), root_ / "nodes" / i};
      if (node.contains("camera"))
        result_.cameras.push_back(carrier);
      if (extension_of(node, "KHR_lights_punctual") != nullptr)
        result_.lights.push_back(carrier);
    }
  }

  // COLOR_0 is read.
  void add_vertex_colours() {
    const json &meshes = list_at(document_, "meshes");
    std::vector<std::size_t> found;
    std::ranges::copy_if(meshes_, std::back_inserter(found), [&](std::size_t mesh) {
      return std::ranges::any_of(meshes.at(mesh).at("primitives"), [](const json &primitive) {
        return primitive.at("attributes").contains("COLOR_1");
      });
    });
    if (!found.empty())
      add(warning_code("gltf-vertex-colours"), root_ / "meshes" / found.front(),
          fmt::format("{}, which are ignored: COLOR_0 alone changes the reflectivity",
                      counted(meshes, found, meshes_.size(), "mesh", "has more vertex colours than COLOR_0",
                              "have more vertex colours than COLOR_0")));
  }

  void add_variants() {
    const json *part = extension_of(document_, "KHR_materials_variants");
    if (part == nullptr)
      return;
    std::size_t mapped = 0;
    for (const std::size_t mesh : meshes_)
      for (const json &primitive : list_at(document_, "meshes").at(mesh).at("primitives"))
        mapped += extension_of(primitive, "KHR_materials_variants") != nullptr ? 1u : 0u;
    if (mapped > 0)
      add(warning_code("gltf-variants"), root_ / "extensions" / "KHR_materials_variants",
          fmt::format("{} variants of materials for {} primitives are ignored: each primitive has its own "
                      "material; change that in the file",
                      list_at(*part, "variants").size(), mapped));
  }

  void add_animation_pointers() {
    std::size_t pointers = 0;
    for (const json &animation : list_at(document_, "animations"))
      for (const json &channel : animation.at("channels"))
        pointers += channel.at("target").at("path") == "pointer" ? 1u : 0u;
    if (pointers > 0)
      add(warning_code("gltf-animation-pointer"), root_ / "animations",
          fmt::format("{} animation channel{} a property by KHR_animation_pointer, which is ignored: only "
                      "nodes move, by translation, rotation and scale",
                      pointers, pointers == 1 ? " changes" : "s change"));
  }

  void add_scenes() {
    if (const std::size_t scenes = list_at(document_, "scenes").size(); scenes > 1)
      add(warning_code("gltf-scenes"), root_ / "scenes",
          fmt::format("one of {} scenes is taken, number {}: change \"scene\" in the file for another",
                      scenes, document_.value("scene", std::size_t{0})));
  }

  void add_extensions() {
    for (const json &name : list_at(document_, "extensionsUsed"))
      note_extension(name.get<std::string>());
    for (const auto &[key, value] : document_.items())
      if (key != "extras")
        note_extensions_in(value, key);
    for (const auto &[name, parts] : extensions_)
      add(warning_code("gltf-extension"), root_ / "extensionsUsed",
          fmt::format("the extension {} is not supported and ignored ({} in the file)", in_quotes(name),
                      parts == 0   ? "it has no part"
                      : parts == 1 ? "it has 1 part"
                                   : fmt::format("it has {} parts", parts)));
  }

  // Nothing of one that is supported, or told of otherwise.
  std::size_t *note_extension(const std::string &name) {
    const bool is_told =
        std::ranges::find(silent_extensions, std::string_view(name)) != silent_extensions.end() ||
        std::ranges::find(gltf_extensions(), std::string_view(name), &GltfExtension::name) !=
            gltf_extensions().end();
    return is_told ? nullptr : &extensions_.try_emplace(name, 0).first->second;
  }

  // Of everything below `value`, which a member `key` holds.
  void note_extensions_in(const json &value, const std::string &key) {
    if (key == "extensions" && value.is_object())
      for (const auto &[name, part] : value.items())
        if (std::size_t *parts = note_extension(name))
          ++*parts;
    if (value.is_array())
      for (const json &element : value)
        if (element.is_structured())
          note_extensions_in(element, "");
    if (value.is_object())
      for (const auto &[name, member] : value.items())
        if (name != "extras" && member.is_structured())
          note_extensions_in(member, name);
  }

  const json &document_;
  const std::vector<std::size_t> &nodes_;
  Place root_;
  std::set<std::size_t> meshes_, materials_;      // that the active scene has
  std::map<std::string, std::size_t> extensions_; // and how often a part of each stands in the file
  IgnoredFeatures result_;
};

} // namespace

IgnoredFeatures ignored_features(const json &document, const std::vector<std::size_t> &nodes,
                                 const Place &root) {
  return Features(document, nodes, root).found();
}

std::vector<Warning> unused_carriers(const IgnoredFeatures &features, const std::vector<std::string> &used) {
  const auto is_used = [&](const GltfCarrier &carrier) {
    return std::ranges::find(used, carrier.node) != used.end();
  };
  const auto pose_of = [](const GltfCarrier &carrier) {
    return carrier.node.empty() ? std::string("{\"node\": NAME}, once the node has a name")
                                : fmt::format("{{\"node\": {}}}", in_quotes(carrier.node));
  };
  std::vector<Warning> warnings;
  if (const auto &cameras = features.cameras; !cameras.empty() && std::ranges::none_of(cameras, is_used))
    warnings.push_back(input_warning(
        warning_code("gltf-camera"), cameras.front().place,
        fmt::format(
            "the file has {} camera{}, and no pose names a node of one: sensors and their lenses come "
            "from the setup; a sensor is at this camera by the pose {}",
            cameras.size(), cameras.size() == 1 ? "" : "s", pose_of(cameras.front()))));
  std::vector<GltfCarrier> lights = features.lights;
  std::erase_if(lights, is_used);
  if (!lights.empty())
    warnings.push_back(input_warning(
        warning_code("gltf-lights"), lights.front().place,
        fmt::format("{} of {} light{} {} ignored: light comes from the setup's illuminators alone; one is at "
                    "this light by the pose {}",
                    lights.size(), features.lights.size(), features.lights.size() == 1 ? "" : "s",
                    lights.size() == 1 ? "is" : "are", pose_of(lights.front()))));
  return warnings;
}

} // namespace pmdsim
