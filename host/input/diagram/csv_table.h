#pragma once
// CSV files with a header line: named columns in any order, blank lines skipped, every error with its line.

#include "host/input/file/input_error.h"
#include "host/input/file/input_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <tuple>
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

namespace pmdsim {

// A table of up to N columns. `text` has to outlive it, and holds no NUL.
template <std::size_t N>
class CsvTable {
public:
  using Names = std::array<const char *, N>;

  // Reads the header line, which has the first `required` columns and perhaps others.
  CsvTable(std::filesystem::path file, std::string_view text, const Names &names, std::size_t required)
      : file_(std::move(file)), names_(names),
        reader_(file_.string(), text.data(), text.data() + text.size()) {
    read_header();
    for (std::size_t column = 0; column < required; ++column)
      if (!has(column))
        throw input_error(here(), fmt::format("missing column {}", names_[column]));
  }

  bool has(std::size_t column) const { return reader_.has_column(names_[column]); }

  // False at the end of the file.
  bool next_row() {
    fields_.fill("");
    try {
      return std::apply([&](auto &...fields) { return reader_.read_row(fields...); }, fields_);
    } catch (const io::error::base &) {
      const auto columns =
          std::ranges::count_if(names_, [&](const char *name) { return reader_.has_column(name); });
      throw input_error(here(), fmt::format("expected {} columns", columns));
    }
  }

  // The field of the row read last; empty where the table has no such column.
  std::string_view text(std::size_t column) const { return fields_[column]; }
  double number(std::size_t column, NumberRange range = {}) const {
    return number_of(text(column), names_[column], here(), range);
  }

  // The line read last; the header's as long as no row was.
  TextPlace here() const { return {file_, std::max(reader_.get_file_line(), 1u)}; }
  TextPlace end() const { return {file_, reader_.get_file_line() + 1}; }

private:
  void read_header() {
    try {
      std::apply([&](auto... names) { reader_.read_header(io::ignore_missing_column, names...); }, names_);
    } catch (const io::error::extra_column_in_header &extra) {
      throw input_error(here(), fmt::format("unknown column {}", in_quotes(extra.column_name)));
    } catch (const io::error::duplicated_column_in_header &doubled) {
      throw input_error(here(), fmt::format("column {} appears twice", doubled.column_name));
    } catch (const io::error::base &) {
      throw input_error(here(), "expected a header line");
    }
  }

  std::filesystem::path file_;
  Names names_;
  io::CSVReader<N, io::trim_chars<' ', '\t'>, io::no_quote_escape<','>, io::throw_on_overflow,
                io::empty_line_comment>
      reader_;
  std::array<const char *, N> fields_{};
};

} // namespace pmdsim
