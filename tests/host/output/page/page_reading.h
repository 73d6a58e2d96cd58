#pragma once
// A page read as a browser reads it, by code of its own: base64, gzip, bytes in order again.

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <libdeflate.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim::test {

inline std::string text_in(const std::filesystem::path &file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// What stands in the element with that id; empty where there is none.
inline std::string content_of(const std::string &page, const std::string &id) {
  const std::size_t named = page.find("id=\"" + id + "\">");
  if (named == std::string::npos)
    return {};
  const std::size_t begin = page.find('>', named) + 1;
  return page.substr(begin, page.find("</script>", begin) - begin);
}

inline nlohmann::json run_of(const std::string &page) {
  return nlohmann::json::parse(content_of(page, "run"));
}

inline std::string from_base64(const std::string &text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char character : text) {
    if (character == '=')
      break;
    REQUIRE(digits.find(character) != std::string::npos);
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(character));
    if ((count += 6) >= 8)
      bytes += static_cast<char>(bits >> (count -= 8) & 255u);
  }
  return bytes;
}

// The values' bytes of a block that packed() has made.
inline std::string unpacked(const std::string &block, std::size_t value_bytes) {
  const std::string zip = from_base64(block);
  REQUIRE(zip.size() >= 18);
  std::uint32_t size = 0; // gzip ends with it
  for (std::size_t i = 0; i < 4; ++i)
    size |= static_cast<std::uint32_t>(static_cast<unsigned char>(zip[zip.size() - 4 + i])) << (8 * i);
  std::string planes(size, '\0');
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> inflater(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  REQUIRE(libdeflate_gzip_decompress(inflater.get(), zip.data(), zip.size(), planes.data(), planes.size(),
                                     nullptr) == LIBDEFLATE_SUCCESS);
  std::string bytes(size, '\0');
  const std::size_t values = size / value_bytes;
  for (std::size_t i = 0; i < size; ++i)
    bytes[i % values * value_bytes + i / values] = planes[i];
  return bytes;
}

} // namespace pmdsim::test
