#include "host/input/gltf/document.h"

#include "host/input/file/input_file.h"
#include "host/input/file/json_file.h"
#include "host/input/gltf/extensions.h"
#include "host/input/schema/schema_check.h"
#include "host/input/words/file_kind.h"

#include <cstdint>
#include <fmt/format.h>
#include <memory>
#include <string_view>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr std::string_view glb_magic = "glTF";
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t bin_chunk = 0x004e4942;

std::uint32_t little_endian_u32(std::string_view bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i)
    value |= std::uint32_t{static_cast<unsigned char>(bytes[offset + i])} << (8 * i);
  return value;
}

struct Chunk {
  std::uint32_t type;
  std::string_view bytes;
};

// The chunk at the front of `rest`, which moves on behind it.
Chunk next_chunk(std::string_view &rest, const Place &whole_file) {
  if (rest.size() < 8)
    throw input_error(whole_file, "a .glb chunk is cut short, expected a header of 8 bytes");
  const std::uint32_t length = little_endian_u32(rest, 0);
  const std::uint32_t type = little_endian_u32(rest, 4);
  rest.remove_prefix(8);
  if (length > rest.size())
    throw input_error(whole_file, fmt::format("a .glb chunk is cut short, expected {} bytes, found {}",
                                              length, rest.size()));
  const Chunk chunk{type, rest.substr(0, length)};
  rest.remove_prefix(length);
  return chunk;
}

struct Text {
  std::string_view json;
  std::string_view binary_chunk;
};

Text split_glb(std::string_view bytes, const Place &whole_file) {
  if (bytes.size() < 12 || little_endian_u32(bytes, 4) != 2)
    throw input_error(whole_file, "expected a .glb header of version 2");
  if (little_endian_u32(bytes, 8) != bytes.size())
    throw input_error(whole_file, fmt::format("the .glb header tells {} bytes, the file has {}",
                                              little_endian_u32(bytes, 8), bytes.size()));
  std::string_view rest = bytes.substr(12);
  const Chunk first = next_chunk(rest, whole_file);
  if (first.type != json_chunk)
    throw input_error(whole_file, "expected JSON as the first .glb chunk");
  if (rest.empty())
    return {first.bytes, {}};
  const Chunk second = next_chunk(rest, whole_file);
  return {first.bytes, second.type == bin_chunk ? second.bytes : std::string_view{}};
}

// Of `bytes` what `chunk` shows of them, in the same memory.
void keep_only(std::string_view chunk, std::string &bytes) {
  const auto begin = chunk.empty() ? 0 : static_cast<std::size_t>(chunk.data() - bytes.data());
  bytes.resize(begin + chunk.size());
  bytes.erase(0, begin);
}

void refuse_other_kinds(std::string_view bytes, const Place &whole_file) {
  constexpr std::string_view expected = "expected glTF 2.0 (.gltf or .glb)";
  const std::string kind = kind_of_file(whole_file.file, bytes);
  if (!kind.empty())
    throw input_error(whole_file, fmt::format("is {}, {}", kind, expected));
  if (bytes.empty())
    throw input_error(whole_file, fmt::format("is empty, {}", expected));
}

void refuse_other_versions(const json &document, const Place &root) {
  const std::string version = document.at("asset").at("version");
  if (!version.starts_with("2."))
    throw input_error(root / "asset" / "version", "expected \"2.0\", found " + in_quotes(version));
}

} // namespace

const json &list_at(const json &object, const char *key) {
  static const json empty_array = json::array();
  if (!object.is_object())
    return empty_array;
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : empty_array;
}

GltfDocument read_gltf_document(const std::filesystem::path &file, const Place &named_at) {
  const auto bytes = std::make_shared<std::string>(read_regular_file(file, max_gltf_file_bytes, named_at));
  const bool is_glb = std::string_view(*bytes).starts_with(glb_magic);
  Place root{file};
  if (!is_glb)
    refuse_other_kinds(*bytes, root);
  const Text text = is_glb ? split_glb(*bytes, root) : Text{*bytes, {}};
  constexpr std::size_t failure_bytes = 1024;
  static const DocumentSchema schema(json::parse(gltf_schema_text), failure_bytes);

  GltfDocument document{parse_json(text.json, file, Comments::refused), {}};
  if (is_glb) { // whose lines nobody sees
    keep_only(text.binary_chunk, *bytes);
    document.binary_chunk = std::move(*bytes);
  } else {
    root.source = std::make_shared<const JsonSource>(JsonSource{bytes});
  }
  schema.check(document.json, root);
  refuse_other_versions(document.json, root);
  refuse_other_extensions(document.json, root);
  check_references(document.json, root);
  return document;
}

} // namespace pmdsim
