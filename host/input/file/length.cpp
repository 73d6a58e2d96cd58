#include "host/input/file/length.h"

#include <charconv>
#include <map>
#include <system_error>

namespace pmdsim {
namespace {

const std::map<std::string_view, double> units_per_m{{"m", 1.0}, {"mm", 1e3}, {"um", 1e6}};

} // namespace

std::optional<double> length_m(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc())
    return std::nullopt;
  const auto unit = units_per_m.find(text.substr(static_cast<std::size_t>(end - text.data())));
  if (unit == units_per_m.end())
    return std::nullopt;
  const double length_m = number / unit->second;
  return length_m >= least_written_length_m && length_m <= largest_written_length_m ? std::optional(length_m)
                                                                                    : std::nullopt;
}

} // namespace pmdsim
