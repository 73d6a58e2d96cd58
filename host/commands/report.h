#pragma once
// What commands print on stdout.

#include "engine/accuracy.h"

#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace pmdsim {

// Text as it is, at once. Throws Error (output) where stdout cannot take it.
void print(const std::string &text);
void print(const nlohmann::ordered_json &json);

// "20 MHz".
std::string frequency_text(double modulation_hz);

// A number for a table, six significant digits; "-" for NaN.
std::string table_number(double value);

// "12.3 µm", four significant digits.
std::string micrometres_text(double length_m);

// A line of what was summed, one of the error claimed and found; only those that say something.
std::string accuracy_text(Mode mode, const AccuracyReport &report);

// Over the values that are finite; NaN where there is none.
struct Spread {
  double min, median, max;
};
Spread spread_of(std::span<const float> values);
Spread spread_of(std::span<const double> values);

} // namespace pmdsim
