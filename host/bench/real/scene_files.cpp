#include "host/bench/real/scene_files.h"

#include "host/bench/sweep.h"
#include "host/output/files/manifest.h"
#include "host/output/files/output_set.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <string_view>
#include <vector>

namespace pmdsim {
namespace {

using nlohmann::ordered_json;

constexpr int float32_type = 5126, uint32_type = 5125; // glTF 2.0, "Accessor Data Types"

static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

// A primitive a surface, on the same positions.
struct Geometry {
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> indices;
  std::vector<std::size_t> first; // index of each surface, and where the last one ends
};

Geometry geometry_of(const Scene &scene) {
  Geometry geometry{{scene.positions_m.begin(), scene.positions_m.end()}, {}, {0}};
  for (std::size_t surface = 0; surface < scene.surfaces.size(); ++surface) {
    for (const Triangle &triangle : scene.triangles)
      if (triangle.surface == surface)
        geometry.indices.insert(geometry.indices.end(), triangle.vertices.begin(), triangle.vertices.end());
    geometry.first.push_back(geometry.indices.size());
  }
  return geometry;
}

ordered_json triple(const glm::vec3 &value) { return {value.x, value.y, value.z}; }

ordered_json gltf_json(const Scene &scene, const Geometry &geometry, const std::string &buffer) {
  glm::vec3 least(std::numeric_limits<float>::max()), most = -least;
  for (const glm::vec3 &position : geometry.positions)
    least = glm::min(least, position), most = glm::max(most, position);
  const std::size_t positions = geometry.positions.size() * sizeof(glm::vec3);
  const std::size_t indices = geometry.indices.size() * sizeof(std::uint32_t);
  ordered_json accessors{{{"bufferView", 0},
                          {"componentType", float32_type},
                          {"count", geometry.positions.size()},
                          {"type", "VEC3"},
                          {"min", triple(least)},
                          {"max", triple(most)}}};
  ordered_json primitives = ordered_json::array(), materials = ordered_json::array();
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    accessors.push_back({{"bufferView", 1},
                         {"byteOffset", geometry.first[i] * sizeof(std::uint32_t)},
                         {"componentType", uint32_type},
                         {"count", geometry.first[i + 1] - geometry.first[i]},
                         {"type", "SCALAR"}});
    primitives.push_back({{"attributes", {{"POSITION", 0}}}, {"indices", i + 1}, {"material", i}});
    const double grey = scene.surfaces[i].reflectivity;
    materials.push_back({{"name", scene.objects[i]},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {grey, grey, grey, 1}}}},
                         {"doubleSided", scene.surfaces[i].double_sided}});
  }
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {{{"mesh", 0}}}},
          {"meshes", {{{"primitives", primitives}}}},
          {"materials", materials},
          {"accessors", accessors},
          {"bufferViews",
           {{{"buffer", 0}, {"byteLength", positions}},
            {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", indices}}}},
          {"buffers", {{{"uri", buffer}, {"byteLength", positions + indices}}}}};
}

template <class Value>
std::string_view bytes_of(const std::vector<Value> &values) {
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(Value)};
}

ordered_json setup_json(const Setup &setup, const std::string &scene) {
  const Sensor &sensor = setup.start.sensors.front();
  return {{"scene", scene},
          {"backscatter", "lambert"},
          {"shadows", "auto"},
          {"sensors",
           {{{"name", sensor.name},
             {"resolution", {sensor.resolution.x, sensor.resolution.y}},
             {"pixel_pitch_m", {sensor.pixel_pitch_m.x, sensor.pixel_pitch_m.y}},
             {"focal_length_m", sensor.focal_length_m},
             {"modulation_hz", sensor.modulation_hz}}}},
          {"illuminators",
           {{{"name", "ring"}, {"pose", {{"sensor", sensor.name}}}, {"diodes", {{"file", "diodes.csv"}}}}}}};
}

std::string diodes_csv(const Illuminator &illuminator) {
  std::string text = "x_m,y_m,z_m,axis_x,axis_y,axis_z,intensity_w_sr,pattern\n";
  for (const auto &[position_m, axis, intensity_w_sr, pattern, across] : illuminator.diodes)
    text += fmt::format("{},{},{},{},{},{},{},{}\n", position_m.x, position_m.y, position_m.z, axis.x, axis.y,
                        axis.z, intensity_w_sr, pattern.order);
  return text;
}

} // namespace

Setup setup_of_kind(const SceneKind &kind, std::uint32_t triangles, std::uint32_t columns) {
  Setup setup = paper_ring();
  setup.backscatter = Backscatter::lambert;
  setup.start.scene = kind.make(triangles);
  for (Diode &diode : setup.start.illuminators.front().diodes)
    diode.pattern = {Pattern::Kind::cosine, 3.0};
  Sensor &sensor = setup.start.sensors.front();
  sensor.resolution = glm::uvec2(columns);
  sensor.focal_length_m = sensor.pixel_pitch_m.x * columns / (2.0 * half_view_tangent);
  return setup;
}

SceneFiles write_scene_files(const std::filesystem::path &directory, const std::string &name,
                             const Setup &setup) {
  const Scene &scene = setup.start.scene;
  const Geometry geometry = geometry_of(scene);
  OutputSet files(directory);
  const auto add = [&](const std::string &file, const std::string &text) {
    files.add(file, [&](OutputFile &output) { output.write(text); });
  };
  files.add(name + ".bin", [&](OutputFile &output) {
    output.write(bytes_of(geometry.positions));
    output.write(bytes_of(geometry.indices));
  });
  add(name + ".gltf", json_text(gltf_json(scene, geometry, name + ".bin")));
  add(name + ".json", json_text(setup_json(setup, name + ".gltf")));
  add("diodes.csv", diodes_csv(setup.start.illuminators.front()));
  files.publish();
  return {directory / (name + ".json"), directory / (name + ".gltf"), directory / "diodes.csv"};
}

} // namespace pmdsim
