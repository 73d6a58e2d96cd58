#include "host/output/page/packed_values.h"

#include <algorithm>
#include <cstdint>
#include <libdeflate.h>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

namespace pmdsim {
namespace {

constexpr int level = 7; // 8 and 9 take twice the time for 1 % less

std::vector<std::byte> shuffled(std::span<const std::byte> bytes, std::size_t value_bytes) {
  const std::size_t values = bytes.size() / value_bytes;
  std::vector<std::byte> planes(bytes.size());
  for (std::size_t plane = 0; plane < value_bytes; ++plane)
    for (std::size_t i = 0; i < values; ++i)
      planes[plane * values + i] = bytes[i * value_bytes + plane];
  return planes;
}

std::vector<std::uint8_t> zipped(const std::vector<std::byte> &bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(level), libdeflate_free_compressor);
  if (!compressor)
    throw std::bad_alloc();
  std::vector<std::uint8_t> zip(libdeflate_gzip_compress_bound(compressor.get(), bytes.size()));
  zip.resize(libdeflate_gzip_compress(compressor.get(), bytes.data(), bytes.size(), zip.data(), zip.size()));
  return zip;
}

std::string base64(const std::vector<std::uint8_t> &bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (k < there ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= there ? digits[bits >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

} // namespace

std::string packed(std::span<const std::byte> bytes, std::size_t value_bytes) {
  return base64(zipped(shuffled(bytes, value_bytes)));
}

} // namespace pmdsim
