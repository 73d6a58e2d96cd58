#pragma once
// Small glTF documents for tests to load or to break.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim::test {

// A data URI for bytes, and the bytes of a list of numbers.
std::string data_uri(std::string_view bytes);
template <class T>
std::string bytes_of(const std::vector<T> &values) {
  return {reinterpret_cast<const char *>(values.data()), values.size() * sizeof(T)};
}

// Positions of a triangle a metre before a camera at the origin, counter-clockwise as that sees it.
std::vector<float> triangle_positions();

// One mesh of one primitive on node 0, "object". Accessor 0 is POSITION; `indices`, where any, accessor 1
// (u16).
nlohmann::json document(const std::vector<float> &positions, const std::vector<std::uint16_t> &indices,
                        int mode);
nlohmann::json one_triangle(); // plain, mode TRIANGLES

// Adds a buffer of these bytes and a bufferView of all of it, or an accessor on such a view too. They return
// the new bufferView's or accessor's index.
std::size_t add_view(nlohmann::json &document, std::string_view bytes);
std::size_t add_accessor(nlohmann::json &document, std::string_view bytes, int component_type,
                         std::size_t count, const std::string &type);

// A .glb of that document; its first buffer becomes the BIN chunk.
std::string glb(nlohmann::json document, std::string bin_chunk);

} // namespace pmdsim::test
