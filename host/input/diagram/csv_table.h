#pragma once
// CSV files with a header line: named columns in any order, blank lines skipped, every error with its line.

#include "host/input/diagram/csv_text.h"
#include "host/input/file/input_error.h"
#include "host/input/file/input_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>
#include <tuple>
#include <vector>
#define CSV_IO_NO_THREAD
#include <libfccp/csv.h>

namespace pmdsim {

// A table of up to N columns. `text` outlives it, and holds no NUL.
template <std::size_t N>
class CsvTable {
public:
  using Names = std::array<const char *, N>;

  // Reads the header line, which has the first `required` columns and perhaps others.
  CsvTable(std::filesystem::path file, std::string_view text, const Names &names, std::size_t required)
      : file_(std::move(file)), text_(text), names_(names),
        reader_(file_.string(), text.data(), text.data() + text.size()) {
    read_header(required);
    std::vector<std::string> missing;
    for (std::size_t column = 0; column < required; ++column)
      if (!has(column))
        missing.emplace_back(names_[column]);
    if (!missing.empty())
      throw input_error(here(), missing_columns_text(missing));
    header_ = csv_fields(written());
  }

  bool has(std::size_t column) const { return reader_.has_column(names_[column]); }

  // False at the end of the file.
  bool next_row() {
    fields_.fill("");
    try {
      return std::apply([&](auto &...fields) { return reader_.read_row(fields...); }, fields_);
    } catch (const io::error::base &) {
      throw input_error(here(), fmt::format("expected {} columns, {}", header_.size(),
                                            row_problem(written(), header_.size())));
    }
  }

  // The field of the row read last; empty where the table has no such column.
  std::string_view text(std::size_t column) const { return fields_[column]; }
  double number(std::size_t column, NumberRange range = {}) const {
    try {
      return number_of(text(column), names_[column], here(), range);
    } catch (const Error &) { // again with its column, for which the text is read from its front
      return number_of(text(column), names_[column], at(column), range);
    }
  }
  // The field of the row read last.
  TextPlace at(std::size_t column) const {
    TextPlace place = here();
    const auto index = static_cast<std::size_t>(std::ranges::find(header_, names_[column]) - header_.begin());
    const std::vector<std::string_view> fields = csv_fields(written());
    if (index < fields.size())
      place.column =
          text_place(file_, written(), static_cast<std::size_t>(fields[index].data() - written().data()))
              .column;
    return place;
  }

  // The line read last; the header's as long as no row was.
  TextPlace here() const { return {file_, std::max(reader_.get_file_line(), 1u)}; }
  TextPlace end() const { return {file_, reader_.get_file_line() + 1}; }

private:
  // The line read last.
  std::string_view written() const { return line_of_text(text_, here().line); }

  void read_header(std::size_t required) {
    try {
      std::apply([&](auto... names) { reader_.read_header(io::ignore_missing_column, names...); }, names_);
    } catch (const io::error::extra_column_in_header &) {
      if (const auto problem = header_problem(written()))
        throw input_error(here(), *problem);
      throw input_error(
          here(), unknown_columns_text(csv_fields(written()), {names_.begin(), names_.end()}, required));
    } catch (const io::error::duplicated_column_in_header &doubled) {
      throw input_error(here(), fmt::format("column {} appears twice", doubled.column_name));
    } catch (const io::error::base &) {
      throw input_error(here(), "expected a header line");
    }
  }

  std::filesystem::path file_;
  std::string_view text_;
  Names names_;
  io::CSVReader<N, io::trim_chars<' ', '\t'>, io::no_quote_escape<','>, io::throw_on_overflow,
                io::empty_line_comment>
      reader_;
  std::array<const char *, N> fields_{};
  std::vector<std::string_view> header_;
};

} // namespace pmdsim
