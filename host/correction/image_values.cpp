#include "host/correction/image_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numbers>

namespace pmdsim {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

std::vector<double> finite_ones(const std::vector<double> &values) {
  std::vector<double> finite;
  std::ranges::copy_if(values, std::back_inserter(finite), [](double value) { return std::isfinite(value); });
  return finite;
}

// Whether the least value is at the beginning of a turn and the largest at its end. Distances are so by
// chance alone, but where the ambiguity range has that length.
bool fill_a_turn(const std::vector<double> &values, double ambiguity_m) {
  constexpr double turn = 2.0 * std::numbers::pi, near_end = 2e-3, rounding = 1e-6;
  const auto [least, most] = std::ranges::minmax(values);
  return least < near_end * turn && most > (1.0 - near_end) * turn && most <= (1.0 + rounding) * turn &&
         std::abs(ambiguity_m - turn) > near_end * turn;
}

} // namespace

std::string_view quantity_name(Quantity quantity) {
  constexpr std::array<std::string_view, 3> names{"distance", "phase", "depth"};
  return names.at(static_cast<std::size_t>(quantity));
}

Meaning meaning_of(std::string_view name, bool whole_numbers, const std::optional<Quantity> &quantity,
                   const std::optional<double> &unit) {
  const auto has = [&](std::string_view part) { return name.find(part) != std::string_view::npos; };
  const Quantity by_name = has("phase")                    ? Quantity::phase
                           : has("depth") || name == "z_m" ? Quantity::depth
                                                           : Quantity::distance;
  const Quantity meant = quantity.value_or(by_name);
  if (unit)
    return {meant, *unit};
  if (meant == Quantity::phase)
    return {meant, 1.0};
  return {meant, has("_mm") || (whole_numbers && !has("_m")) ? 1e-3 : 1.0};
}

std::vector<double> values_of(const ImageArray &array, const Meaning &meaning,
                              const std::optional<double> &invalid) {
  const bool is_length = meaning.quantity != Quantity::phase;
  // As a float has it, where the image is of floats.
  const auto is_invalid = [&](double value) {
    return invalid && (value == *invalid || value == double{static_cast<float>(*invalid)});
  };
  std::vector<double> values = array.values;
  for (double &value : values) {
    const bool is_none = !std::isfinite(value) || (is_length && value <= 0.0) ||
                         (array.largest > 0.0 && value == array.largest) || is_invalid(value);
    value = is_none ? no_value : value * meaning.unit;
  }
  return values;
}

std::vector<Warning> doubts_of_distances(const std::vector<double> &distance_m, double ambiguity_m,
                                         const std::string &place) {
  constexpr double most_ambiguities = 10.0;
  std::vector<double> values = finite_ones(distance_m);
  if (values.empty())
    return {};
  if (fill_a_turn(values, ambiguity_m))
    return {{warning_code("image-is-phase"), place,
             "the distances fill 0 to 2 pi as phases do, expected metres; phase? --quantity phase"}};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  if (*middle <= most_ambiguities * ambiguity_m)
    return {};
  return {
      {warning_code("image-unit"), place,
       fmt::format("half of the distances are beyond {:.4g} m, {:.4g} times the ambiguity range of {:.4g} "
                   "m; millimetres? --unit mm",
                   *middle, *middle / ambiguity_m, ambiguity_m)}};
}

} // namespace pmdsim
