#include "tests/host/input/gltf/builder.h"

namespace pmdsim::test {

using nlohmann::json;

namespace {

std::string u32(std::size_t value) { return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)}); }

std::string padded(std::string text, char padding) {
  while (text.size() % 4 != 0)
    text.push_back(padding);
  return text;
}

} // namespace

std::string data_uri(std::string_view bytes) {
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : alphabet[group >> (18 - 6 * k) & 63u];
  }
  return text;
}

std::vector<float> triangle_positions() { return {-1, -1, -1, 1, -1, -1, 0, 1, -1}; }

json document(const std::vector<float> &positions, const std::vector<std::uint16_t> &indices, int mode) {
  const std::string position_bytes = bytes_of(positions), index_bytes = bytes_of(indices);
  json result = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"name", "object"}, {"mesh", 0}}}},
      {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"mode", mode}}}}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", positions.size() / 3}, {"type", "VEC3"}}}},
      {"bufferViews", {{{"buffer", 0}, {"byteLength", position_bytes.size()}}}},
      {"buffers",
       {{{"byteLength", position_bytes.size() + index_bytes.size()},
         {"uri", data_uri(position_bytes + index_bytes)}}}},
  };
  if (!indices.empty()) {
    result["meshes"][0]["primitives"][0]["indices"] = 1;
    result["accessors"].push_back(
        {{"bufferView", 1}, {"componentType", 5123}, {"count", indices.size()}, {"type", "SCALAR"}});
    result["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", position_bytes.size()}, {"byteLength", index_bytes.size()}});
  }
  return result;
}

json one_triangle() { return document(triangle_positions(), {}, 4); }

std::size_t add_view(json &document, std::string_view bytes) {
  document["buffers"].push_back({{"byteLength", bytes.size()}, {"uri", data_uri(bytes)}});
  document["bufferViews"].push_back(
      {{"buffer", document["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  return document["bufferViews"].size() - 1;
}

std::size_t add_accessor(json &document, std::string_view bytes, int component_type, std::size_t count,
                         const std::string &type) {
  const std::size_t view = add_view(document, bytes);
  document["accessors"].push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return document["accessors"].size() - 1;
}

std::string glb(json gltf, std::string bin_chunk) {
  gltf["buffers"][0].erase("uri");
  const std::string text = padded(gltf.dump(), ' ');
  bin_chunk = padded(std::move(bin_chunk), '\0');
  const std::string chunks =
      u32(text.size()) + "JSON" + text + u32(bin_chunk.size()) + std::string("BIN\0", 4) + bin_chunk;
  return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks;
}

} // namespace pmdsim::test
