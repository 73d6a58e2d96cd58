#include "host/output/files/channel.h"

#include <bit>
#include <fmt/format.h>

namespace pmdsim {
namespace {

static_assert(std::endian::native == std::endian::little, "the arrays are written as they lie in memory");

constexpr std::size_t preamble_bytes = 10; // magic, version, header length
constexpr std::size_t alignment_bytes = 64;

const char *type_name(std::span<const float>) { return "<f4"; }
const char *type_name(std::span<const std::uint32_t>) { return "<u4"; }
const char *type_name(std::span<const double>) { return "<f8"; }

} // namespace

std::string npy_header(const Channel &channel, const glm::uvec2 &resolution) {
  const char *type = std::visit([](auto values) { return type_name(values); }, written_values(channel));
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}, {}), }}", type,
                                   resolution.y, resolution.x);
  const std::size_t unpadded = preamble_bytes + header.size() + 1;
  header.append((alignment_bytes - unpadded % alignment_bytes) % alignment_bytes, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(length & 0xff) +
         static_cast<char>(length >> 8) + header;
}

void write_npy(OutputFile &file, const Channel &channel, const glm::uvec2 &resolution) {
  std::visit(
      [&](auto values) {
        const std::string header = npy_header(channel, resolution);
        file.reserve(header.size() + values.size_bytes());
        file.write(header);
        file.write({reinterpret_cast<const char *>(values.data()), values.size_bytes()});
      },
      written_values(channel));
}

} // namespace pmdsim
