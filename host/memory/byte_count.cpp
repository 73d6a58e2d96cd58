#include "host/memory/byte_count.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <system_error>

namespace pmdsim {
namespace {

struct ByteUnit {
  std::string_view name;
  double bytes;
};

constexpr std::array byte_units{ByteUnit{"B", 1.0},      ByteUnit{"kB", 1e3},     ByteUnit{"KB", 1e3},
                                ByteUnit{"MB", 1e6},     ByteUnit{"GB", 1e9},     ByteUnit{"TB", 1e12},
                                ByteUnit{"KiB", 0x1p10}, ByteUnit{"MiB", 0x1p20}, ByteUnit{"GiB", 0x1p30},
                                ByteUnit{"TiB", 0x1p40}};
constexpr double most_bytes = 1e15;

} // namespace

std::optional<std::uint64_t> byte_count(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc())
    return std::nullopt;
  std::string_view name = text.substr(static_cast<std::size_t>(end - text.data()));
  name.remove_prefix(std::min(name.find_first_not_of(' '), name.size()));
  const auto unit = std::ranges::find(byte_units, name, &ByteUnit::name);
  if (unit == byte_units.end())
    return std::nullopt;
  const double bytes = number * unit->bytes;
  return bytes >= 1.0 && bytes <= most_bytes ? std::optional(static_cast<std::uint64_t>(bytes))
                                             : std::nullopt;
}

std::string byte_text(std::uint64_t bytes) {
  constexpr std::array names{"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  auto value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < names.size(); ++unit)
    value /= 1e3;
  return fmt::format("{:.3g} {}", value, names.at(unit));
}

} // namespace pmdsim
