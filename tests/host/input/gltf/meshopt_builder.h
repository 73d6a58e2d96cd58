#pragma once
// glTF documents whose bufferViews EXT_meshopt_compression fills.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

// Streams as meshoptimizer writes them; a vertex's bytes are a multiple of 4.
std::string vertex_stream(const std::string &bytes, std::size_t vertex_bytes);
std::string triangle_stream(const std::vector<unsigned> &indices);
std::string index_stream(const std::vector<unsigned> &indices);

// A buffer with the stream, a placeholder buffer for what it holds, and a bufferView of that. Returns the
// bufferView's index.
std::size_t add_compressed_view(nlohmann::json &document, const std::string &stream, const std::string &mode,
                                std::size_t stride_bytes, std::size_t count);

// The extension's part of a bufferView.
nlohmann::json &compression(nlohmann::json &document, std::size_t view);

// A square of two triangles in mode TRIANGLES, positions (accessor 0) and 16-bit indices (1) compressed;
// bufferViews 2 and 3, streams in buffers 1 and 3.
nlohmann::json compressed_square();

} // namespace pmdsim::test
