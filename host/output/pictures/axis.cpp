#include "host/output/pictures/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim {
namespace {

struct Step {
  double mantissa;
  int exponent;
  double value() const { return mantissa * std::pow(10.0, exponent); }
};

// Positions of the first and last tick in steps; the tolerance keeps ticks that rounding put just outside.
std::pair<double, double> tick_numbers(const Range &range, double step) {
  constexpr double tolerance = 1e-9;
  return {std::ceil(range.min / step - tolerance), std::floor(range.max / step + tolerance)};
}

Step round_step(const Range &range, int max_ticks) {
  constexpr std::array mantissas{1.0, 2.0, 5.0};
  for (int exponent = static_cast<int>(std::floor(std::log10(range.span() / max_ticks)));; ++exponent)
    for (const double mantissa : mantissas) {
      const Step step{mantissa, exponent};
      const auto [first, last] = tick_numbers(range, step.value());
      if (last - first + 1.0 <= max_ticks)
        return step;
    }
}

int left_out_exponent(const Range &range) {
  const double largest = std::max(std::abs(range.min), std::abs(range.max));
  const bool everyday = largest >= 0.01 && largest < 1e5;
  return everyday ? 0 : 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
}

std::string superscript(int exponent) {
  constexpr std::array digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += digits[static_cast<std::size_t>(digit - '0')];
  return text;
}

} // namespace

Axis make_axis(const Range &range, int max_ticks) {
  const Step step = round_step(range, max_ticks);
  Axis axis{range, left_out_exponent(range), {}};
  const auto [first, last] = tick_numbers(range, step.value());
  const int count = static_cast<int>(last - first) + 1;
  for (int tick = 0; tick < count; ++tick) {
    const double value = (first + tick) * step.value() + 0.0; // + 0.0: no "-0"
    const double shown = value / std::pow(10.0, axis.exponent);
    std::string label = fmt::format("{:.{}f}", shown, std::max(0, axis.exponent - step.exponent));
    if (label.front() == '-')
      label.replace(0, 1, "−");
    axis.ticks.push_back({value, std::move(label)});
  }
  return axis;
}

Axis make_log_axis(const Range &range) {
  constexpr double tolerance = 1e-9;
  Axis axis{{std::log10(range.min), std::log10(range.max)}, 0, {}};
  const int first = static_cast<int>(std::floor(axis.range.min)), last = static_cast<int>(axis.range.max) + 1;
  const bool few = axis.range.span() < 2.0;
  for (int exponent = first; exponent <= last; ++exponent)
    for (const double mantissa : {1.0, 2.0, 5.0}) {
      const double value = exponent + std::log10(mantissa);
      const bool is_inside = value >= axis.range.min - tolerance && value <= axis.range.max + tolerance;
      if (is_inside && (few || mantissa == 1.0))
        axis.ticks.push_back({value, fmt::format("{:g}", mantissa * std::pow(10.0, exponent))});
    }
  return axis;
}

std::string axis_title(const std::string &quantity, const std::string &unit, int exponent) {
  std::string scaled_unit = exponent == 0 ? "" : "10" + superscript(exponent);
  if (!unit.empty())
    scaled_unit += (scaled_unit.empty() ? "" : " ") + unit;
  return scaled_unit.empty() ? quantity : fmt::format("{} ({})", quantity, scaled_unit);
}

} // namespace pmdsim
