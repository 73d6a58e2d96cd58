#include "host/input/file/json_file.h"

#include "host/input/file/input_error.h"
#include "host/input/file/json_position.h"
#include "host/input/file/json_syntax.h"
#include "host/input/file/memory_request.h"
#include "host/input/words/utf8.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <vector>

namespace pmdsim {

using nlohmann::json;

namespace {

// Of what is written well: a number or a byte.
std::string library_problem(const json::exception &exception) {
  const std::string_view what = exception.what();
  if (what.find("number overflow") != what.npos)
    return "number too large";
  return what.find("UTF-8") != what.npos
             ? "not valid JSON, expected UTF-8, found another byte: save the file as UTF-8"
             : "not valid JSON";
}

Error syntax_error(std::string_view text, std::size_t position, const std::filesystem::path &file,
                   Comments comments, const json::exception &exception) {
  if (const auto problem = json_problem(text, comments == Comments::allowed))
    return input_error(text_place(file, text, problem->at), "not valid JSON, " + problem->message);
  const std::size_t offset = std::min(std::max<std::size_t>(position, 1) - 1, text.size());
  return input_error(text_place(file, text, offset), library_problem(exception));
}

// Reads a document without building it, so that nothing deep or doubled is ever built.
class Guard : public nlohmann::json_sax<json> {
public:
  Guard(std::string_view text, const std::filesystem::path &file, Comments comments)
      : text_(text), file_(file), comments_(comments) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t &) override { return value(); }
  bool string(string_t &) override { return value(); }
  bool binary(binary_t &) override { return value(); }
  bool start_object(std::size_t) override { return open(false); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_array() override { return close(); }

  bool key(string_t &name) override {
    Container &object = open_.back();
    if (!object.keys.insert(name).second)
      throw doubled(name);
    object.key = name;
    return true;
  }

  std::size_t values() const { return values_; } // so far

  bool parse_error(std::size_t position, const std::string &, const json::exception &exception) override {
    throw syntax_error(text_, position, file_, comments_, exception);
  }

private:
  struct Container {
    bool is_array;
    std::size_t index = 0;
    std::string key;
    std::set<std::string> keys;
  };

  // The place of the innermost `depth` containers' current member.
  Place here(std::size_t depth) const {
    Place place{file_};
    for (std::size_t i = 0; i < depth; ++i)
      place = open_[i].is_array ? place / open_[i].index : place / open_[i].key;
    return place;
  }

  // Names both lines, the place being the object's.
  Error doubled(const std::string &name) const {
    const Place object = here(open_.size() - 1);
    const auto line_of = [&](int occurrence) {
      const auto position = position_in_json(text_, object.pointer / name, occurrence);
      return text_place(file_, text_, position ? position->key : 0);
    };
    const std::string within = object.pointer.empty() ? "" : object.pointer.to_string() + ": ";
    const Error error = input_error(line_of(2), fmt::format("{}key {} appears twice, first in line {}",
                                                            within, in_quotes(name), line_of(1).line));
    return {error.code(), error.what(), {error.where().file, in_one_line(object.pointer.to_string())}};
  }

  bool value() {
    if (++values_ > max_json_values)
      throw input_error(Place{file_}, fmt::format("expected at most {} values", max_json_values));
    if (!open_.empty())
      ++open_.back().index;
    return true;
  }

  bool open(bool is_array) {
    if (open_.size() == max_json_depth)
      throw input_error(Place{file_},
                        fmt::format("nested too deep, expected at most {} levels", max_json_depth));
    open_.push_back({is_array, 0, {}, {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return value();
  }

  std::string_view text_;
  const std::filesystem::path &file_;
  Comments comments_;
  std::vector<Container> open_;
  std::size_t values_ = 0;
};

// JSON Schema, draft-07, section 6.1.1: a number without a fractional part is an integer, however written.
void make_integer(json &number) {
  constexpr double largest_exact = 9007199254740992.0; // 2^53
  const auto value = number.get<double>();
  if (std::abs(value) <= largest_exact && std::trunc(value) == value)
    number = static_cast<std::int64_t>(value);
}

// Integers beyond 64 bits with a sign become doubles, as bounds are looked at with a sign.
void settle_numbers(json &value) {
  if (value.is_structured())
    for (json &each : value)
      settle_numbers(each);
  else if (value.is_number_float())
    make_integer(value);
  else if (value.is_number_unsigned() &&
           value.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max())
    value = value.get<double>();
}

} // namespace

void check_json(std::string_view text, const std::filesystem::path &file, Comments comments) {
  Guard guard(text, file, comments);
  json::sax_parse(text.begin(), text.end(), &guard, json::input_format_t::json, true,
                  comments == Comments::allowed);
  constexpr std::size_t value_bytes = 64; // about, in a list or an object
  // A text is in the parser and in the document, whose longest parts are its own.
  require_memory(guard.values() * value_bytes + 2 * text.size(), Place{file},
                 fmt::format("a document of {} values", guard.values()));
}

json parse_json(std::string_view text, const std::filesystem::path &file, Comments comments) {
  check_json(text, file, comments);
  // All at once and then looked at: nlohmann's callbacks take a time that grows with the square of a list.
  json parsed = json::parse(text.begin(), text.end(), nullptr, true, comments == Comments::allowed);
  settle_numbers(parsed);
  return parsed;
}

} // namespace pmdsim
