#include "host/output/pictures/colouring.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace pmdsim {
namespace {

constexpr double rounding = 1e-5; // relative to the largest value

double largest_of(const Range &range) { return std::max(std::abs(range.min), std::abs(range.max)); }

// A constant image still gets a bar with some extent, but rounding noise is not blown up to a pattern.
Range widened(const Range &range) {
  const double largest = largest_of(range);
  const double least_span = largest > 0.0 ? rounding * largest : 1.0;
  if (range.span() >= least_span)
    return range;
  const double middle = 0.5 * (range.min + range.max);
  return {middle - 0.5 * least_span, middle + 0.5 * least_span};
}

// All of one sign, and closer to each other than to zero.
bool is_far_from_zero(const Range &range) {
  return range.min * range.max > 0.0 && range.span() < std::min(std::abs(range.min), std::abs(range.max));
}

} // namespace

bool ValueSpread::is_constant() const {
  return !is_empty() && greatest - least <= rounding * largest_of({least, greatest});
}

ValueSpread spread_of_values(std::span<const float> values) {
  std::vector<float> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float value) { return std::isfinite(value); });
  if (finite.empty())
    return {};
  const auto [least, greatest] = std::minmax_element(finite.begin(), finite.end());
  ValueSpread spread{static_cast<double>(*least), static_cast<double>(*greatest), {}};
  const auto left_out = static_cast<std::ptrdiff_t>(finite.size() / 200);
  const auto low = finite.begin() + left_out;
  const auto high = finite.end() - 1 - left_out;
  std::nth_element(finite.begin(), low, finite.end());
  spread.robust.min = static_cast<double>(*low);
  std::nth_element(finite.begin(), high, finite.end());
  spread.robust.max = static_cast<double>(*high);
  return spread;
}

ValueSpread hull(const ValueSpread &a, const ValueSpread &b) {
  if (a.is_empty() || b.is_empty())
    return a.is_empty() ? b : a;
  return {std::min(a.least, b.least),
          std::max(a.greatest, b.greatest),
          {std::min(a.robust.min, b.robust.min), std::max(a.robust.max, b.robust.max)}};
}

Colour Colouring::at(double value) const { return colours->at((value - range.min) / range.span()); }

Colouring colouring_of(const ValueSpread &values, ColourScale scale) {
  if (scale == ColourScale::turn)
    return {&twilight, {0.0, 2.0 * std::numbers::pi}};
  if (scale == ColourScale::share)
    return {&viridis, {0.0, 1.0}};
  if (scale == ColourScale::sequential || is_far_from_zero(values.robust))
    return {&viridis, widened(values.robust)};
  const double largest = values.is_empty() ? 0.0 : largest_of(values.robust);
  return {&blue_white_red, largest > 0.0 ? Range{-largest, largest} : Range{-1.0, 1.0}};
}

Colour colour_of_id(std::uint32_t id) {
  // Our own: neighbours differ in hue and lightness.
  static constexpr std::array<Colour, 12> colours{{{0.18, 0.47, 0.71},
                                                   {0.96, 0.62, 0.22},
                                                   {0.25, 0.60, 0.30},
                                                   {0.84, 0.35, 0.36},
                                                   {0.60, 0.48, 0.75},
                                                   {0.55, 0.40, 0.30},
                                                   {0.93, 0.60, 0.78},
                                                   {0.78, 0.76, 0.25},
                                                   {0.30, 0.75, 0.80},
                                                   {0.10, 0.25, 0.45},
                                                   {0.65, 0.85, 0.60},
                                                   {0.45, 0.12, 0.25}}};
  constexpr std::array shades{1.0, 0.7, 1.25};
  const double shade = shades.at(id / colours.size() % shades.size());
  Colour colour = colours.at(id % colours.size());
  for (double &level : colour)
    level = std::min(1.0, shade * level);
  return colour;
}

} // namespace pmdsim
