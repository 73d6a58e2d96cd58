#pragma once
// Binary PLY files with one element of scalar properties, read as their specification says.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace pmdsim::test {

struct PlyFile {
  std::vector<std::string> comments, properties;      // in the file's order
  std::map<std::string, std::vector<double>> columns; // of each property, a value for each vertex
  std::size_t vertices = 0;

  const std::vector<double> &operator[](const std::string &property) const { return columns.at(property); }
};

inline double ply_value(const std::string &type, const char *bytes) {
  if (type == "uchar")
    return static_cast<unsigned char>(*bytes);
  std::uint32_t bits = 0;
  for (std::size_t i = 4; i-- > 0;)
    bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  if (type == "uint")
    return bits;
  if (type == "float")
    return static_cast<double>(std::bit_cast<float>(bits));
  throw std::runtime_error("PLY: unexpected type " + type);
}

// Throws std::runtime_error where it is none.
inline PlyFile parsed_ply(const std::string &bytes) {
  PlyFile ply;
  std::vector<std::string> types;
  std::istringstream text(bytes);
  std::string line, word;
  std::getline(text, line);
  std::getline(text, word);
  if (line != "ply" || word != "format binary_little_endian 1.0")
    throw std::runtime_error("PLY: unexpected beginning");
  while (std::getline(text, line) && line != "end_header") {
    std::istringstream words(line);
    words >> word;
    if (word == "comment") {
      ply.comments.push_back(line.substr(8));
    } else if (word == "element") {
      words >> word >> ply.vertices;
    } else if (word == "property") {
      words >> types.emplace_back() >> ply.properties.emplace_back();
    } else {
      throw std::runtime_error("PLY: unexpected line " + line);
    }
  }
  auto at = static_cast<std::size_t>(text.tellg());
  for (std::size_t vertex = 0; vertex < ply.vertices; ++vertex)
    for (std::size_t i = 0; i < types.size(); ++i) {
      const std::size_t size = types[i] == "uchar" ? 1 : 4;
      if (at + size > bytes.size())
        throw std::runtime_error("PLY: shorter than its header says");
      ply.columns[ply.properties[i]].push_back(ply_value(types[i], bytes.data() + at));
      at += size;
    }
  if (at != bytes.size())
    throw std::runtime_error("PLY: longer than its header says");
  return ply;
}

} // namespace pmdsim::test
