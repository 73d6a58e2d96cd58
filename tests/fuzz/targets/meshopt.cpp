// Streams of EXT_meshopt_compression. The first bytes say how many elements of which kind and size there are;
// all others are the stream.

#include "tests/fuzz/target.h"

#include "host/input/gltf/data/meshopt.h"

#include <array>

using namespace pmdsim;

namespace {

nlohmann::json document_of(const std::uint8_t *head, std::size_t stream_bytes) {
  constexpr std::array modes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
  constexpr std::array filters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
  const std::size_t count = 1 + (head[0] + 256u * head[1]) % 1024u,
                    stride_bytes = 1 + head[2]; // few, for speed; at least 1
  return {{"buffers", {{{"byteLength", stream_bytes}}, {{"byteLength", count * stride_bytes}}}},
          {"bufferViews",
           {{{"buffer", 1},
             {"byteLength", count * stride_bytes},
             {"extensions",
              {{"EXT_meshopt_compression",
                {{"buffer", 0},
                 {"byteLength", stream_bytes},
                 {"byteStride", stride_bytes},
                 {"count", count},
                 {"mode", modes[head[3] % modes.size()]},
                 {"filter", filters[head[3] / 16 % filters.size()]}}}}}}}}};
}

} // namespace

FUZZ_TARGET(meshopt) {
  constexpr std::size_t head_bytes = 4;
  if (size < head_bytes)
    return 0;
  const nlohmann::json document = document_of(data, size - head_bytes);
  const std::vector<Bytes> buffers{Bytes(data + head_bytes, data + size), {}};
  fuzz::accepts([&] { decode_meshopt_views(document, buffers, Place{"scene.gltf"}); });
  return 0;
}
