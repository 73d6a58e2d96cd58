#include "tests/host/input/gltf/moving_gltf.h"

#include "tests/host/input/gltf/builder.h"

#include <cmath>
#include <map>

namespace pmdsim::test {

using nlohmann::json;

std::size_t add_accessor(json &gltf, const std::string &bytes, int component_type, std::size_t count,
                         const std::string &type) {
  gltf["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  gltf["bufferViews"].push_back({{"buffer", gltf["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                               {"componentType", component_type},
                               {"count", count},
                               {"type", type}});
  return gltf["accessors"].size() - 1;
}

std::size_t add_floats(json &gltf, const std::vector<float> &values, const std::string &type) {
  const std::map<std::string, std::size_t> components{{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  return add_accessor(gltf, bytes_of(values), 5126, values.size() / components.at(type), type);
}

void animate(json &gltf, std::size_t node, const std::string &path, const std::string &interpolation,
             const std::vector<float> &times_s, const std::vector<float> &values) {
  const std::size_t input = add_floats(gltf, times_s, "SCALAR");
  const std::size_t output = add_floats(gltf, values, path == "rotation" ? "VEC4" : "VEC3");
  gltf["animations"].push_back(
      {{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}});
}

json skinned_arm() {
  json gltf = document({0, 0, 0, 1, 1, 0, 0, 2, 0}, {}, 4);
  gltf["nodes"] = {{{"name", "arm"}, {"mesh", 0}, {"skin", 0}},
                   {{"name", "lower"}, {"children", {2}}},
                   {{"name", "upper"}, {"translation", {0, 1, 0}}}};
  gltf["scenes"][0]["nodes"] = {0, 1};
  gltf["skins"] = {{{"joints", {1, 2}}}};
  gltf["skins"][0]["inverseBindMatrices"] =
      add_floats(gltf, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1, //
                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                 "MAT4");
  json &attributes = gltf["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      add_accessor(gltf, bytes_of<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}), 5121, 3, "VEC4");
  attributes["WEIGHTS_0"] = add_floats(gltf, {1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0}, "VEC4");
  return gltf;
}

std::vector<float> quarter_turn() {
  const float half = std::sqrt(0.5f);
  return {0, 0, half, half};
}

} // namespace pmdsim::test
