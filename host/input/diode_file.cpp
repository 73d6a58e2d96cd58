#include "host/input/diode_file.h"

#include "host/input/limits.h"
#include "host/input/regular_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string_view>
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

namespace pmdsim {

namespace {

constexpr std::size_t max_file_bytes = std::size_t{1} << 26;

// A row's fields in the order of the columns' names, whatever the order in the file.
constexpr std::array<const char *, 8> columns = {
    "x_m", "y_m", "z_m", "axis_x", "axis_y", "axis_z", "intensity_w_sr", "pattern"};
using Fields = std::array<const char *, columns.size()>;
using Reader = io::CSVReader<columns.size(), io::trim_chars<' ', '\t'>, io::no_quote_escape<','>,
                             io::throw_on_overflow, io::empty_line_comment>;

// Both inclusive.
struct Range {
  double lowest, highest;
};
constexpr Range coordinates_m{-max_coordinate_m, max_coordinate_m};
constexpr Range intensities_w_sr{0.0, max_intensity_w_sr};
constexpr Range pattern_orders{0.0, max_pattern_order};

double number(std::string_view text, std::string_view column, const TextPlace &place) {
  double value = 0.0;
  const bool has_plus = text.starts_with('+') && !text.starts_with("+-"); // from_chars takes none
  const char *begin = text.data() + (has_plus ? 1 : 0);
  const char *end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stopped != end || !std::isfinite(value))
    throw input_error(place, fmt::format("{}: expected a number, found {}", column, in_quotes(text)));
  return value;
}

double number_in(Range range, std::string_view text, std::string_view column, const TextPlace &place) {
  const double value = number(text, column, place);
  if (value < range.lowest || value > range.highest)
    throw input_error(place, fmt::format("{}: expected a number from {} to {}, found {}", column,
                                         range.lowest, range.highest, in_quotes(text)));
  return value;
}

Pattern pattern_of(std::string_view text, const TextPlace &place) {
  if (text == "isotropic")
    return {};
  const bool is_number = !text.empty() && std::string_view("0123456789.+-").find(text[0]) != text.npos;
  if (!is_number)
    throw input_error(
        place,
        fmt::format("pattern: expected an order or isotropic; a diagram's file, {}, is not supported yet",
                    in_quotes(text)));
  return {Pattern::Kind::cosine, number_in(pattern_orders, text, "pattern", place)};
}

glm::dvec3 unit_axis(const glm::dvec3 &axis, const TextPlace &place) {
  const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
  if (largest == 0.0)
    throw input_error(place, "expected an axis, found zero");
  return glm::normalize(axis / largest);
}

Diode diode_of(const Fields &fields, const TextPlace &place) {
  const auto field = [&](std::size_t column) { return number(fields[column], columns[column], place); };
  const auto coordinate_m = [&](std::size_t column) {
    return number_in(coordinates_m, fields[column], columns[column], place);
  };
  return {{coordinate_m(0), coordinate_m(1), coordinate_m(2)},
          unit_axis({field(3), field(4), field(5)}, place),
          number_in(intensities_w_sr, fields[6], columns[6], place),
          pattern_of(fields[7], place)};
}

// The reader takes a NUL for the end of a field.
void refuse_nul(std::string_view text, const std::filesystem::path &file) {
  const std::size_t nul = text.find('\0');
  if (nul == text.npos)
    return;
  const std::string_view before = text.substr(0, nul);
  const auto line = static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  throw input_error(TextPlace{file, line}, "expected text, found a NUL byte");
}

void read_header(Reader &reader, const std::filesystem::path &file) {
  const auto here = [&] { return TextPlace{file, std::max(reader.get_file_line(), 1u)}; };
  try {
    reader.read_header(io::ignore_no_column, columns[0], columns[1], columns[2], columns[3], columns[4],
                       columns[5], columns[6], columns[7]);
  } catch (const io::error::missing_column_in_header &missing) {
    throw input_error(here(), fmt::format("missing column {}", missing.column_name));
  } catch (const io::error::extra_column_in_header &extra) {
    throw input_error(here(), fmt::format("unknown column {}", in_quotes(extra.column_name)));
  } catch (const io::error::duplicated_column_in_header &doubled) {
    throw input_error(here(), fmt::format("column {} appears twice", doubled.column_name));
  } catch (const io::error::base &) {
    throw input_error(here(), "expected a header line");
  }
}

bool read_row(Reader &reader, Fields &fields, const std::filesystem::path &file) {
  try {
    return reader.read_row(fields[0], fields[1], fields[2], fields[3], fields[4], fields[5], fields[6],
                           fields[7]);
  } catch (const io::error::base &) {
    throw input_error(TextPlace{file, reader.get_file_line()},
                      fmt::format("expected {} columns", columns.size()));
  }
}

} // namespace

std::vector<Diode> read_diode_file(const std::filesystem::path &file, const Place &named_at) {
  const std::string text = read_regular_file(file, max_file_bytes, named_at);
  refuse_nul(text, file);
  Reader reader(file.string(), text.data(), text.data() + text.size());
  read_header(reader, file);
  std::vector<Diode> diodes;
  Fields fields{};
  while (read_row(reader, fields, file)) {
    const TextPlace place{file, reader.get_file_line()};
    if (diodes.size() == max_diodes)
      throw input_error(place, fmt::format("expected at most {} diodes", max_diodes));
    diodes.push_back(diode_of(fields, place));
  }
  if (diodes.empty())
    throw input_error(TextPlace{file, reader.get_file_line() + 1}, "expected at least one diode");
  return diodes;
}

} // namespace pmdsim
