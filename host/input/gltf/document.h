#pragma once
// A .gltf or .glb file as a checked JSON document, before tinygltf sees it.

#include "host/input/file/input_error.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// The limit of the scene's file, and of all its buffers together.
inline constexpr std::size_t max_gltf_file_bytes = std::size_t{1} << 30;

using Bytes = std::vector<unsigned char>;

// Where the files lie that a scene names by URI: in its folder or below, or wherever the user may read.
enum class UriFiles { beside, anywhere };
inline constexpr const char *allow_outside_option = "--allow-outside"; // for the latter; and as errors say it
inline constexpr const char *allow_outside_words = "--allow-outside, allow_outside in Python";

struct GltfDocument {
  nlohmann::json json;      // every key that is read has the right type, every index exists
  std::string binary_chunk; // a .glb's BIN chunk; empty where there is none
  UriFiles files = UriFiles::beside;
};

// Throws Error (input); one that concerns the file as a whole is at `named_at`, the place that names the
// file.
GltfDocument read_gltf_document(const std::filesystem::path &file, const Place &named_at);

// An array of an object, or an empty one: not all of them have passed the schema.
const nlohmann::json &list_at(const nlohmann::json &object, const char *key);

// Throws Error (input) where an index of a document that has passed the glTF schema names nothing, or a
// feature is used that is not supported yet.
void check_references(const nlohmann::json &document, const Place &root);

} // namespace pmdsim
