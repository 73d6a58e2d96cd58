#include "host/input/gltf/data/meshopt.h"

#include "host/input/file/memory_request.h"
#include "host/input/gltf/extensions.h"

#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <meshoptimizer.h>
#include <string>

namespace pmdsim {

using nlohmann::json;

namespace {

constexpr const char *meshopt_extension = "EXT_meshopt_compression";

// The extension's part of a bufferView or buffer.
const json *meshopt_part(const json &object) { return extension_part(object, meshopt_extension); }

// A stream's zeros take the least room in a vertex buffer: 2 bits for 16 equal bytes. A shorter one need not
// cost the memory of what it claims to hold.
constexpr std::size_t max_expansion = 64;

struct CompressedView {
  std::size_t index;                                                 // in the file's /bufferViews
  Place place;                                                       // of the extension's part
  std::size_t buffer, byte_offset, byte_length, stride_bytes, count; // byte_length: of the stream
  std::string mode, filter;

  std::size_t decoded_bytes() const { return stride_bytes * count; } // below 2^41
};

CompressedView compressed_view(const json &part, std::size_t index, const Place &place) {
  const auto number = [&](const char *key) { return part.value(key, std::size_t{0}); };
  return {index,
          place,
          number("buffer"),
          number("byteOffset"),
          number("byteLength"),
          number("byteStride"),
          number("count"),
          part.at("mode"),
          part.value("filter", "NONE")};
}

void check_stride(const CompressedView &view) {
  const auto require = [&](bool is_good, const char *expected) {
    if (!is_good)
      throw input_error(view.place / "byteStride",
                        fmt::format("expected {}, found {}", expected, view.stride_bytes));
  };
  if (view.mode != "ATTRIBUTES")
    require(view.stride_bytes == 2 || view.stride_bytes == 4, "2 or 4 for indices");
  else if (view.filter == "OCTAHEDRAL")
    require(view.stride_bytes == 4 || view.stride_bytes == 8, "4 or 8 for \"OCTAHEDRAL\"");
  else if (view.filter == "QUATERNION")
    require(view.stride_bytes == 8, "8 for \"QUATERNION\"");
  else
    require(view.stride_bytes % 4 == 0, "a multiple of 4 for \"ATTRIBUTES\"");
}

// Against the bufferView that it fills, which says how long and how far apart the decoded elements are.
void check_parent(const CompressedView &view, const json &parent, const json &document, const Place &place) {
  const auto stride_bytes = parent.value("byteStride", view.stride_bytes);
  const auto length_bytes = parent.at("byteLength").get<std::size_t>();
  if (stride_bytes != view.stride_bytes)
    throw input_error(view.place / "byteStride",
                      fmt::format("expected the bufferView's {}, found {}", stride_bytes, view.stride_bytes));
  if (length_bytes != view.decoded_bytes())
    throw input_error(place / "byteLength",
                      fmt::format("expected {}, {} elements of {} bytes, found {}", view.decoded_bytes(),
                                  view.count, view.stride_bytes, length_bytes));
  const std::size_t end = parent.value("byteOffset", std::size_t{0}) + length_bytes;
  const json &buffer = document.at("buffers").at(parent.at("buffer").get<std::size_t>());
  if (end > buffer.at("byteLength").get<std::size_t>())
    throw input_error(place,
                      fmt::format("ends at byte {}, its buffer has {}", end, buffer.at("byteLength").dump()));
}

void check_stream(const CompressedView &view, const Bytes &source) {
  if (view.mode != "ATTRIBUTES" && view.filter != "NONE")
    throw input_error(view.place / "filter", fmt::format("expected \"NONE\" for \"{}\"", view.mode));
  check_stride(view);
  if (view.mode == "TRIANGLES" && view.count % 3 != 0)
    throw input_error(view.place / "count",
                      fmt::format("expected a multiple of 3 for \"TRIANGLES\", found {}", view.count));
  const std::size_t end = view.byte_offset + view.byte_length;
  if (end > source.size())
    throw input_error(view.place, fmt::format("ends at byte {}, its buffer has {}", end, source.size()));
  if (view.decoded_bytes() > max_expansion * view.byte_length)
    throw input_error(view.place, fmt::format("its {} bytes are too short for {} elements of {} bytes",
                                              view.byte_length, view.count, view.stride_bytes));
}

Bytes decode(const CompressedView &view, const Bytes &source) {
  using Decoder = int (*)(void *, std::size_t, std::size_t, const unsigned char *, std::size_t);
  static const std::map<std::string, Decoder> decoders{{"ATTRIBUTES", meshopt_decodeVertexBuffer},
                                                       {"TRIANGLES", meshopt_decodeIndexBuffer},
                                                       {"INDICES", meshopt_decodeIndexSequence}};
  using Filter = void (*)(void *, std::size_t, std::size_t);
  static const std::map<std::string, Filter> filters{{"OCTAHEDRAL", meshopt_decodeFilterOct},
                                                     {"QUATERNION", meshopt_decodeFilterQuat},
                                                     {"EXPONENTIAL", meshopt_decodeFilterExp}};
  require_memory(view.decoded_bytes(), view.place, "what it decodes to");
  Bytes decoded(view.decoded_bytes());
  if (decoders.at(view.mode)(decoded.data(), view.count, view.stride_bytes, source.data() + view.byte_offset,
                             view.byte_length) != 0)
    throw input_error(view.place, fmt::format("its bytes cannot be decoded as {} elements of \"{}\"",
                                              view.count, view.mode));
  if (const auto filter = filters.find(view.filter); filter != filters.end())
    filter->second(decoded.data(), view.count, view.stride_bytes);
  return decoded;
}

bool is_marked(const json &buffer) {
  const json *part = meshopt_part(buffer);
  return part != nullptr && part->value("fallback", false);
}

std::vector<CompressedView> checked_views(const json &document, const std::vector<Bytes> &buffers,
                                          const Place &root) {
  std::vector<CompressedView> result;
  const json views = document.value("bufferViews", json::array());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Place parent = root / "bufferViews" / i;
    const json *part = meshopt_part(views[i]);
    if (part == nullptr) {
      if (is_marked(document.at("buffers").at(views[i].at("buffer").get<std::size_t>())))
        throw input_error(parent / "buffer",
                          fmt::format("is a fallback buffer, expected {} here", meshopt_extension));
      continue;
    }
    result.push_back(compressed_view(*part, i, parent / "extensions" / meshopt_extension));
    check_stream(result.back(), buffers[result.back().buffer]);
    check_parent(result.back(), views[i], document, parent);
  }
  return result;
}

} // namespace

std::vector<bool> meshopt_fallbacks(const json &document, const std::vector<bool> &is_absent) {
  std::vector<bool> has_compressed(is_absent.size(), false), has_plain(is_absent.size(), false);
  for (const json &view : document.value("bufferViews", json::array())) {
    std::vector<bool> &referred = meshopt_part(view) != nullptr ? has_compressed : has_plain;
    referred[view.at("buffer").get<std::size_t>()] = true;
  }
  std::vector<bool> result(is_absent.size(), false);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = is_marked(document.at("buffers")[i]) || (is_absent[i] && has_compressed[i] && !has_plain[i]);
  return result;
}

std::vector<DecodedView> decode_meshopt_views(const json &document, const std::vector<Bytes> &buffers,
                                              const Place &root) {
  const std::vector<CompressedView> compressed = checked_views(document, buffers, root);
  std::size_t all_bytes = 0;
  for (const Bytes &bytes : buffers)
    all_bytes += bytes.size();
  for (const CompressedView &view : compressed) {
    all_bytes += view.decoded_bytes();
    if (all_bytes > max_gltf_file_bytes)
      throw input_error(view.place / "count", fmt::format("expected at most {} bytes in all buffers, decoded",
                                                          max_gltf_file_bytes));
  }
  std::vector<DecodedView> result;
  result.reserve(compressed.size());
  for (const CompressedView &view : compressed)
    result.push_back({view.index, decode(view, buffers[view.buffer])});
  return result;
}

} // namespace pmdsim
