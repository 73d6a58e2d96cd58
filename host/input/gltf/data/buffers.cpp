#include "host/input/gltf/data/buffers.h"

#include "host/input/file/input_file.h"
#include "host/input/file/inside_folder.h"
#include "host/input/file/memory_request.h"
#include "host/input/gltf/data/meshopt.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <string_view>
#include <tiny_gltf.h>

namespace pmdsim {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

// RFC 3986 percent-decoding; nothing where a % is not followed by two hexadecimal digits or hides a NUL.
std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned code = 0;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16).ptr;
    if (digits.size() != 2 || end != digits.data() + 2 || code == 0)
      return std::nullopt;
    decoded.push_back(static_cast<char>(code));
    i += 2;
  }
  return decoded;
}

// RFC 3986, section 3.1: a letter, then letters, digits, +, - and . up to the colon.
bool has_scheme(std::string_view uri) {
  const std::string_view scheme = uri.substr(0, uri.find(':'));
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_allowed = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '+' || c == '-' || c == '.';
  };
  return scheme.size() < uri.size() && !scheme.empty() && is_letter(scheme[0]) &&
         std::all_of(scheme.begin(), scheme.end(), is_allowed);
}

// `name` is what the URI at `place` says, decoded.
void refuse_outside(const fs::path &name, const std::string &uri, const Place &place) {
  std::error_code unresolved;
  const bool is_inside = lies_inside(place.file.parent_path(), name, unresolved);
  if (unresolved)
    throw input_error(place, fmt::format("{}: {}", in_quotes(uri), unresolved.message()));
  if (!is_inside)
    throw input_error(place, fmt::format("{} lies outside the scene's folder; put it there, or allow it "
                                         "({}) where you trust the scene",
                                         in_quotes(uri), allow_outside_words));
}

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

// Whether the buffer has no bytes of its own: no URI, and it is not the .glb's BIN chunk.
bool is_absent(const GltfDocument &document, std::size_t index) {
  const std::string uri = document.json.at("buffers")[index].value("uri", std::string{});
  return uri.empty() && (index > 0 || document.binary_chunk.empty());
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
  const std::string bytes = read_front_of_regular_file(file_of_uri(uri, document.files, place / "uri"),
                                                       length_bytes, place / "uri");
  return {bytes.begin(), bytes.end()};
}

} // namespace

fs::path file_of_uri(const std::string &uri, UriFiles files, const Place &place) {
  if (has_scheme(uri))
    throw input_error(place, "expected a relative file name or a data: URI, found " + in_quotes(uri));
  const std::optional<std::string> name = percent_decoded(uri);
  if (!name)
    throw input_error(place, "expected a percent-encoded relative path, found " + in_quotes(uri));
  if (files == UriFiles::beside)
    refuse_outside(*name, uri, place);
  return place.file.parent_path() / *name; // as messages and manifests name it
}

std::vector<Bytes> read_gltf_buffers(const GltfDocument &document, const fs::path &file) {
  const json buffers = document.json.value("buffers", json::array());
  std::vector<bool> absent(buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i)
    absent[i] = is_absent(document, i);
  const std::vector<bool> is_fallback = meshopt_fallbacks(document.json, absent);
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
    require_memory(2 * length_bytes, Place{file} / "buffers" / i / "byteLength", "the buffer");
    result[i] = read_buffer(document, file, i);
  }
  return result;
}

} // namespace pmdsim
