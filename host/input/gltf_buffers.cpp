#include "host/input/gltf_buffers.h"

#include "host/input/regular_file.h"

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

} // namespace

std::vector<Bytes> read_gltf_buffers(const GltfDocument &document, const fs::path &file) {
  const json buffers = document.json.value("buffers", json::array());
  const fs::path folder = folder_of(file);
  std::vector<Bytes> result;
  std::size_t left_bytes = max_gltf_file_bytes;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const Place place = Place{file} / "buffers" / i;
    const auto length_bytes = buffers[i].at("byteLength").get<std::size_t>();
    if (length_bytes > left_bytes)
      throw input_error(place / "byteLength",
                        fmt::format("expected at most {} bytes in all buffers", max_gltf_file_bytes));
    left_bytes -= length_bytes;
    const auto uri = buffers[i].value("uri", std::string{});
    if (uri.empty() && (i > 0 || document.binary_chunk.empty()))
      throw input_error(place, "missing key \"uri\"");
    if (uri.empty())
      result.push_back(front_of_chunk(document.binary_chunk, length_bytes, place));
    else if (uri.starts_with("data:"))
      result.push_back(decoded_data_uri(uri, length_bytes, place / "uri"));
    else
      result.push_back(
          front_of_file(file_in_folder(uri, folder, place / "uri"), length_bytes, place / "uri"));
  }
  return result;
}

} // namespace pmdsim
