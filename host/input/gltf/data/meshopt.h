#pragma once
// EXT_meshopt_compression: bufferViews whose bytes come from a compressed stream in another buffer.

#include "host/input/file/input_error.h"
#include "host/input/gltf/document.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace pmdsim {

// For each buffer whether nobody needs its bytes: it is marked as a fallback for those who cannot decode, or
// has no bytes of its own (`is_absent`) and only compressed views refer to it.
std::vector<bool> meshopt_fallbacks(const nlohmann::json &document, const std::vector<bool> &is_absent);

struct DecodedView {
  std::size_t view; // in the file's /bufferViews
  Bytes bytes;      // of the view's byteLength
};

// Every compressed view of a document that has passed the schema and check_references(), and whose buffers
// these are. Throws Error (input) for a view that breaks the extension's rules, a stream that cannot be
// decoded, and if all bytes, these and the buffers', are more than max_gltf_file_bytes.
std::vector<DecodedView> decode_meshopt_views(const nlohmann::json &document,
                                              const std::vector<Bytes> &buffers, const Place &root);

} // namespace pmdsim
