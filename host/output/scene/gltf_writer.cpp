#include "host/output/scene/gltf_writer.h"

#include "host/output/files/manifest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr int float32_type = 5126, uint32_type = 5125; // glTF 2.0, "Accessor Data Types"
constexpr int vertex_buffer = 34962, index_buffer = 34963;

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

// The vertices from the first to the last that a surface uses, and its triangles' indices into them.
struct Part {
  std::uint32_t first_vertex = 0, vertices = 0;
  std::size_t first_index = 0, indices = 0;
};

struct Geometry {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<Part> parts; // of each surface
};

void append(const Scene &scene, std::uint32_t surface, Geometry &geometry) {
  Part part{.first_index = geometry.indices.size()};
  for (const Triangle &triangle : scene.triangles)
    if (triangle.surface == surface)
      geometry.indices.insert(geometry.indices.end(), triangle.vertices.begin(), triangle.vertices.end());
  part.indices = geometry.indices.size() - part.first_index;
  const std::span<std::uint32_t> own = std::span(geometry.indices).subspan(part.first_index);
  if (!own.empty()) {
    const auto [least, most] = std::ranges::minmax(own);
    part.first_vertex = least;
    part.vertices = most - least + 1;
  }
  for (std::uint32_t &index : own)
    index -= part.first_vertex;
  geometry.parts.push_back(part);
}

Geometry geometry_of(const Scene &scene) {
  Geometry geometry{{scene.positions_m.begin(), scene.positions_m.end()}, {}, {}};
  for (std::uint32_t surface = 0; surface < scene.surfaces.size(); ++surface)
    append(scene, surface, geometry);
  return geometry;
}

ordered_json triple(const glm::vec3 &value) { return {value.x, value.y, value.z}; }

ordered_json positions_accessor(const Geometry &geometry, const Part &part) {
  glm::vec3 least(std::numeric_limits<float>::max()), most = -least;
  for (const glm::vec3 &position : std::span(geometry.positions).subspan(part.first_vertex, part.vertices))
    least = glm::min(least, position), most = glm::max(most, position);
  return {{"bufferView", 0},
          {"byteOffset", part.first_vertex * sizeof(glm::vec3)},
          {"componentType", float32_type},
          {"count", part.vertices},
          {"type", "VEC3"},
          {"min", triple(least)},
          {"max", triple(most)}};
}

ordered_json indices_accessor(const Part &part) {
  return {{"bufferView", 1},
          {"byteOffset", part.first_index * sizeof(std::uint32_t)},
          {"componentType", uint32_type},
          {"count", part.indices},
          {"type", "SCALAR"}};
}

// Accessors 2 i and 2 i + 1 are of surface i, as is material i.
ordered_json mesh_json(const GltfNode &node) {
  ordered_json primitives = ordered_json::array();
  for (const std::uint32_t i : node.surfaces)
    primitives.push_back({{"attributes", {{"POSITION", 2 * i}}}, {"indices", 2 * i + 1}, {"material", i}});
  return {{"primitives", primitives}};
}

ordered_json camera_json(const GltfCamera &camera) {
  return {
      {"type", "perspective"},
      {"perspective", {{"yfov", camera.vertical_view_rad}, {"aspectRatio", camera.aspect}, {"znear", 0.01}}}};
}

// Adds the node and those below it to the document; its index.
std::size_t add_node(const GltfNode &node, ordered_json &document) {
  const auto append_to = [&](const char *list, ordered_json value) {
    document[list].push_back(std::move(value));
    return document[list].size() - 1;
  };
  ordered_json json = ordered_json::object();
  if (!node.name.empty())
    json["name"] = node.name;
  if (node.position_m != glm::dvec3(0.0))
    json["translation"] = {node.position_m.x, node.position_m.y, node.position_m.z};
  if (const glm::dquat &turn = node.rotation; turn != glm::dquat(1.0, 0.0, 0.0, 0.0))
    json["rotation"] = {turn.x, turn.y, turn.z, turn.w};
  if (!node.surfaces.empty())
    json["mesh"] = append_to("meshes", mesh_json(node));
  if (node.camera)
    json["camera"] = append_to("cameras", camera_json(*node.camera));
  const std::size_t index = append_to("nodes", json);
  for (const GltfNode &child : node.children) {
    const std::size_t below = add_node(child, document);
    document["nodes"][index]["children"].push_back(below);
  }
  return index;
}

ordered_json materials_json(const Scene &scene) {
  ordered_json materials = ordered_json::array();
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const double grey = scene.surfaces[i].reflectivity;
    materials.push_back(
        {{"name", scene.objects[i]},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {grey, grey, grey, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
         {"doubleSided", scene.surfaces[i].double_sided}});
  }
  return materials;
}

ordered_json gltf_json(const Scene &scene, const Geometry &geometry, const std::vector<GltfNode> &nodes,
                       const std::string &buffer) {
  const std::size_t positions = geometry.positions.size() * sizeof(glm::vec3);
  const std::size_t indices = geometry.indices.size() * sizeof(std::uint32_t);
  ordered_json document{{"asset", {{"version", "2.0"}, {"generator", "pmdsim"}}},
                        {"scene", 0},
                        {"scenes", ordered_json::array()},
                        {"nodes", ordered_json::array()},
                        {"materials", materials_json(scene)}};
  ordered_json topmost = ordered_json::array();
  for (const GltfNode &node : nodes)
    topmost.push_back(add_node(node, document));
  document["scenes"].push_back({{"nodes", topmost}});
  for (const Part &part : geometry.parts) {
    document["accessors"].push_back(positions_accessor(geometry, part));
    document["accessors"].push_back(indices_accessor(part));
  }
  document["bufferViews"].push_back({{"buffer", 0}, {"byteLength", positions}, {"target", vertex_buffer}});
  document["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", indices}, {"target", index_buffer}});
  document["buffers"].push_back({{"uri", buffer}, {"byteLength", positions + indices}});
  return document;
}

template <class Value>
std::string_view bytes_of(const std::vector<Value> &values) {
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(Value)};
}

} // namespace

void add_gltf(OutputSet &files, const std::string &name, const Scene &scene,
              const std::vector<GltfNode> &nodes) {
  const Geometry geometry = geometry_of(scene);
  files.add(name + ".bin", [&](OutputFile &output) {
    output.write(bytes_of(geometry.positions));
    output.write(bytes_of(geometry.indices));
  });
  files.add(name + ".gltf", [&](OutputFile &output) {
    output.write(json_text(gltf_json(scene, geometry, nodes, name + ".bin")));
  });
}

} // namespace pmdsim
