#include "host/input/file/length.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

namespace pmdsim {
namespace {

struct Unit {
  std::string_view name;
  double per_m;
};
constexpr std::array units{Unit{"m", 1.0}, Unit{"mm", 1e3}, Unit{"um", 1e6}};

} // namespace

std::optional<double> length_m(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc())
    return std::nullopt;
  const auto unit =
      std::ranges::find(units, text.substr(static_cast<std::size_t>(end - text.data())), &Unit::name);
  if (unit == units.end())
    return std::nullopt;
  const double length_m = number / unit->per_m;
  return length_m >= least_written_length_m && length_m <= largest_written_length_m ? std::optional(length_m)
                                                                                    : std::nullopt;
}

} // namespace pmdsim
