#include "host/input/gltf/data/buffers.h"

#include "host/input/file/regular_file.h"
#include "host/input/gltf/data/meshopt.h"

#include <fmt/format.h>
#include <string_view>
#include <tiny_gltf.h>

namespace pmdsim {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

Bytes decoded_data_uri(const std::string &uri, std::size_t length_bytes, const Place &place) {
  Bytes bytes;
  std::string media_type;
  if (!tinygltf::IsDataURI(uri) || !tinygltf::DecodeDataURI(&bytes, media_type, uri, length_bytes, true))
    throw input_error(place, fmt::format("expected a base64 data URI of {} bytes", length_bytes));
  return bytes;
}

Bytes front_of_chunk(std::string_view chunk, std::size_t length_bytes, const Place &buffer) {
  if (chunk.size() < length_bytes)
    throw input_error(buffer, fmt::format("expected {} bytes, found {}", length_bytes, chunk.size()));
  return {chunk.begin(), chunk.begin() + static_cast<std::ptrdiff_t>(length_bytes)};
}

Bytes front_of_file(const fs::path &file, std::size_t length_bytes, const Place &uri) {
  const std::string bytes = read_front_of_regular_file(file, length_bytes, uri);
  return {bytes.begin(), bytes.end()};
}

// Whether the buffer has no bytes of its own: no URI, and it is not the .glb's BIN chunk.
bool is_absent(const GltfDocument &document, std::size_t index) {
  const std::string uri = document.json.at("buffers")[index].value("uri", std::string{});
  return uri.empty() && (index > 0 || document.binary_chunk.empty());
}

std::vector<bool> fallbacks(const GltfDocument &document, std::size_t count) {
  std::vector<bool> absent(count);
  for (std::size_t i = 0; i < count; ++i)
    absent[i] = is_absent(document, i);
  return meshopt_fallbacks(document.json, absent);
}

Bytes read_buffer(const GltfDocument &document, const fs::path &file, std::size_t index) {
  const Place place = Place{file} / "buffers" / index;
  const json &buffer = document.json.at("buffers")[index];
  const auto length_bytes = buffer.at("byteLength").get<std::size_t>();
  if (is_absent(document, index))
    throw input_error(place, "missing key \"uri\"");
  const auto uri = buffer.value("uri", std::string{});
  if (uri.empty())
    return front_of_chunk(document.binary_chunk, length_bytes, place);
  if (uri.starts_with("data:"))
    return decoded_data_uri(uri, length_bytes, place / "uri");
  return front_of_file(file_in_folder(uri, folder_of(file), place / "uri"), length_bytes, place / "uri");
}

} // namespace

std::vector<Bytes> read_gltf_buffers(const GltfDocument &document, const fs::path &file) {
  const json buffers = document.json.value("buffers", json::array());
  const std::vector<bool> is_fallback = fallbacks(document, buffers.size());
  std::vector<Bytes> result(buffers.size());
  std::size_t left_bytes = max_gltf_file_bytes;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    if (is_fallback[i])
      continue;
    const auto length_bytes = buffers[i].at("byteLength").get<std::size_t>();
    if (length_bytes > left_bytes)
      throw input_error(Place{file} / "buffers" / i / "byteLength",
                        fmt::format("expected at most {} bytes in all buffers", max_gltf_file_bytes));
    left_bytes -= length_bytes;
    result[i] = read_buffer(document, file, i);
  }
  return result;
}

} // namespace pmdsim
