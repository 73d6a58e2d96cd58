#include "host/input/array/array_formats.h"

#include "host/input/file/memory_request.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <type_traits>

namespace pmdsim {
namespace {

constexpr std::size_t longest_header = 65536; // that is read; NumPy's own have some hundred bytes

// The literal of a dictionary that follows the preamble.
struct NpyHeader {
  std::string descr;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

class HeaderParser {
public:
  HeaderParser(std::string_view text, const Place &place) : rest_(text), place_(place) {}

  NpyHeader header() {
    NpyHeader header;
    expect('{');
    while (!take('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr")
        header.descr = quoted();
      else if (key == "fortran_order")
        header.fortran_order = truth();
      else if (key == "shape")
        header.shape = shape();
      else
        fail();
      if (!take(',')) {
        expect('}');
        break;
      }
    }
    return header;
  }

private:
  [[noreturn]] void fail() const {
    throw input_error(place_, "expected an NPY header as NumPy writes it, with 'descr', 'fortran_order' and "
                              "'shape'");
  }
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\n"), rest_.size())); }
  bool take(char character) {
    skip_blanks();
    if (!rest_.starts_with(character))
      return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char character) {
    if (!take(character))
      fail();
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (!rest_.starts_with(word))
      return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  std::string quoted() {
    skip_blanks();
    const char quote = rest_.empty() ? '\0' : rest_.front();
    const std::size_t end = quote == '\'' || quote == '"' ? rest_.find(quote, 1) : std::string_view::npos;
    if (end == std::string_view::npos)
      fail();
    const std::string text(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return text;
  }
  bool truth() {
    if (take_word("True"))
      return true;
    if (!take_word("False"))
      fail();
    return false;
  }
  std::vector<std::uint64_t> shape() {
    std::vector<std::uint64_t> sizes;
    expect('(');
    while (!take(')')) {
      std::uint64_t size = 0;
      skip_blanks();
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), size);
      if (error != std::errc())
        fail();
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      sizes.push_back(size);
      if (!take(',')) {
        expect(')');
        break;
      }
    }
    return sizes;
  }

  std::string_view rest_;
  const Place &place_;
};

template <class Value>
double value_at(const char *bytes, bool swapped) {
  std::array<char, sizeof(Value)> own{};
  std::copy_n(bytes, sizeof(Value), own.begin());
  if (swapped)
    std::ranges::reverse(own);
  return static_cast<double>(std::bit_cast<Value>(own));
}

struct ElementType {
  std::string_view code; // of descr, without the order of bytes
  std::size_t bytes;
  bool whole;
  double largest; // of an unsigned type
  double (*value)(const char *bytes, bool swapped);
};

template <class Value>
constexpr ElementType element_type(std::string_view code) {
  return {code, sizeof(Value), std::is_integral_v<Value>,
          std::is_unsigned_v<Value> ? static_cast<double>(std::numeric_limits<Value>::max()) : 0.0,
          value_at<Value>};
}

constexpr std::array element_types{
    element_type<float>("f4"),         element_type<double>("f8"),        element_type<std::uint8_t>("u1"),
    element_type<std::uint16_t>("u2"), element_type<std::uint32_t>("u4"), element_type<std::int8_t>("i1"),
    element_type<std::int16_t>("i2"),  element_type<std::int32_t>("i4"),
};

static_assert(std::endian::native == std::endian::little);

const ElementType &type_of(const NpyHeader &header, const Place &place) {
  const std::string_view code = std::string_view(header.descr).substr(header.descr.empty() ? 0 : 1);
  const auto found = std::ranges::find(element_types, code, &ElementType::code);
  if (found == element_types.end() ||
      std::string_view("<>|=").find(header.descr.front()) == std::string::npos)
    throw input_error(place, fmt::format("expected values of float32, float64 or an integer type of up to "
                                         "32 bits, found {}",
                                         in_quotes(header.descr)));
  return *found;
}

glm::uvec2 resolution_of(const NpyHeader &header, const Place &place) {
  constexpr std::uint64_t most = std::numeric_limits<std::int32_t>::max();
  if (header.shape.size() != 2 ||
      std::ranges::any_of(header.shape, [](std::uint64_t size) { return size < 1 || size > most; }))
    throw input_error(place, fmt::format("expected an array of rows x columns, found one of {} dimensions",
                                         header.shape.size()));
  return {header.shape[1], header.shape[0]};
}

// Its text, and where the data begin.
std::pair<std::string_view, std::size_t> header_text(std::string_view bytes, const Place &place) {
  const auto byte = [&](std::size_t i) -> std::size_t { return static_cast<unsigned char>(bytes[i]); };
  const bool is_long = bytes.size() > npy_magic.size() && byte(6) >= 2;
  const std::size_t begin = is_long ? 12 : 10;
  if (bytes.size() < begin || byte(6) < 1 || byte(6) > 3)
    throw input_error(place, "expected NPY, version 1 to 3");
  std::size_t length = byte(8) | byte(9) << 8u;
  if (is_long)
    length |= byte(10) << 16u | byte(11) << 24u;
  if (length > longest_header || length > bytes.size() - begin)
    throw input_error(place, fmt::format("expected an NPY header of {} bytes, found {} in the file", length,
                                         bytes.size() - begin));
  return {bytes.substr(begin, length), begin + length};
}

} // namespace

ImageArray npy_array(std::string_view bytes, const Place &place) {
  const auto [text, begin] = header_text(bytes, place);
  const NpyHeader header = HeaderParser(text, place).header();
  const ElementType &type = type_of(header, place);
  ImageArray array{.name = "",
                   .resolution = resolution_of(header, place),
                   .whole_numbers = type.whole,
                   .largest = type.largest};
  const std::size_t columns = array.resolution.x, rows = array.resolution.y, values = columns * rows;
  if (const std::size_t found = bytes.size() - begin; found / type.bytes != values || found % type.bytes != 0)
    throw input_error(place, fmt::format("expected {} x {} values of {} bytes each (rows x columns), found "
                                         "{} bytes",
                                         rows, columns, type.bytes, found));
  const bool swapped = header.descr.front() == '>';
  require_memory(values * sizeof(double), place, fmt::format("{} x {} values", rows, columns));
  array.values.resize(values);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t at = header.fortran_order ? column * rows + row : row * columns + column;
      array.values[row * columns + column] = type.value(bytes.data() + begin + at * type.bytes, swapped);
    }
  return array;
}

} // namespace pmdsim
