#include "tests/host/input/gltf/meshopt_builder.h"

#include "tests/host/input/gltf/builder.h"

#include <meshoptimizer.h>

namespace pmdsim::test {

using nlohmann::json;

namespace {

std::string text_of(const std::vector<unsigned char> &bytes, std::size_t size) {
  return {reinterpret_cast<const char *>(bytes.data()), size};
}

} // namespace

std::string vertex_stream(const std::string &bytes, std::size_t vertex_bytes) {
  const std::size_t count = bytes.size() / vertex_bytes;
  std::vector<unsigned char> stream(meshopt_encodeVertexBufferBound(count, vertex_bytes));
  return text_of(stream,
                 meshopt_encodeVertexBuffer(stream.data(), stream.size(), bytes.data(), count, vertex_bytes));
}

std::string triangle_stream(const std::vector<unsigned> &indices) {
  std::vector<unsigned char> stream(meshopt_encodeIndexBufferBound(indices.size(), indices.size()));
  return text_of(stream,
                 meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
}

std::string index_stream(const std::vector<unsigned> &indices) {
  std::vector<unsigned char> stream(meshopt_encodeIndexSequenceBound(indices.size(), indices.size()));
  return text_of(stream,
                 meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
}

std::size_t add_compressed_view(json &document, const std::string &stream, const std::string &mode,
                                std::size_t stride_bytes, std::size_t count) {
  document["buffers"].push_back({{"byteLength", stream.size()}, {"uri", data_uri(stream)}});
  document["buffers"].push_back({{"byteLength", stride_bytes * count},
                                 {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  const std::size_t placeholder = document["buffers"].size() - 1;
  const json part = {{"buffer", placeholder - 1},
                     {"byteLength", stream.size()},
                     {"mode", mode},
                     {"byteStride", stride_bytes},
                     {"count", count}};
  document["bufferViews"].push_back({{"buffer", placeholder},
                                     {"byteLength", stride_bytes * count},
                                     {"extensions", {{"EXT_meshopt_compression", part}}}});
  return document["bufferViews"].size() - 1;
}

json &compression(json &document, std::size_t view) {
  return document["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
}

json compressed_square() {
  const std::vector<float> positions = {0, 0, -1, 1, 0, -1, 1, 1, -1, 0, 1, -1};
  json gltf = document(positions, {0, 1, 2, 0, 2, 3}, 4);
  gltf["accessors"][0]["bufferView"] =
      add_compressed_view(gltf, vertex_stream(bytes_of(positions), 12), "ATTRIBUTES", 12, 4);
  gltf["accessors"][1]["bufferView"] =
      add_compressed_view(gltf, triangle_stream({0, 1, 2, 0, 2, 3}), "TRIANGLES", 2, 6);
  gltf["extensionsUsed"] = {"EXT_meshopt_compression"};
  gltf["extensionsRequired"] = {"EXT_meshopt_compression"};
  return gltf;
}

} // namespace pmdsim::test
