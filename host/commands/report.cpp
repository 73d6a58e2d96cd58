#include "host/commands/report.h"

#include "engine/error.h"
#include "host/output/manifest.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <system_error>

namespace pmdsim {
namespace {

template <typename T>
Spread spread(std::span<const T> values) {
  std::vector<T> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](T value) { return std::isfinite(value); });
  if (finite.empty()) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::nth_element(finite.begin(), middle, finite.end());
  const auto [min, max] = std::minmax_element(finite.begin(), finite.end());
  return {static_cast<double>(*min), static_cast<double>(*middle), static_cast<double>(*max)};
}

} // namespace

void print(const std::string &text) {
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  if (!written || std::fflush(stdout) != 0)
    throw Error(ExitCode::output, fmt::format("standard output: cannot be written: {}",
                                              std::generic_category().message(errno)));
}

void print(const nlohmann::ordered_json &json) { print(json_text(json)); }

std::string frequency_text(double modulation_hz) { return fmt::format("{:.10g} MHz", modulation_hz / 1e6); }

std::string table_number(double value) { return std::isnan(value) ? "-" : fmt::format("{:#.6g}", value); }

Spread spread_of(std::span<const float> values) { return spread(values); }
Spread spread_of(std::span<const double> values) { return spread(values); }

} // namespace pmdsim
