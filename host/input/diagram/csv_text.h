#pragma once
// Lines and fields of a CSV file as they are written, to say what is wrong with them and where.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pmdsim {

// The line with that number, from 1, without its end; empty beyond the last.
std::string_view line_of_text(std::string_view text, std::size_t number);

// Between commas, without blanks around them.
std::vector<std::string_view> csv_fields(std::string_view line);

// Why a line cannot be a header: other separators than commas, or numbers. Nothing where it may be one.
std::optional<std::string> header_problem(std::string_view line);

// Of a header line: which columns nobody knows, what may have been meant by them, and all that are known, the
// first `required` of which have to be there.
std::string unknown_columns_text(const std::vector<std::string_view> &header,
                                 const std::vector<std::string> &known, std::size_t required);
std::string missing_columns_text(const std::vector<std::string> &missing);

// Why a row has more or fewer fields than `expected`, as the end of a message.
std::string row_problem(std::string_view line, std::size_t expected);

} // namespace pmdsim
