#include "host/input/file/json_file.h"
#include "tests/host/input/file/input_error_of.h"

using namespace pmdsim;
using Catch::Equals;
using Catch::StartsWith;

namespace {

std::string error_of(const std::string &text, Comments comments = Comments::refused) {
  return test::input_error_of([&] { parse_json(text, "a.json", comments); });
}

} // namespace

TEST_CASE("JSON text is read") {
  CHECK(parse_json(R"({"a": [1, 2.5, null, true, "x"]})", "a.json", Comments::refused)["a"][1] == 2.5);
  CHECK(parse_json("// why\n{} // so", "a.json", Comments::allowed).empty());
}

TEST_CASE("A number without a fractional part is an integer") {
  const auto numbers = parse_json("[8.0, -2e3, 8.5, 1e300, 9007199254740992.0, 18446744073709551615]",
                                  "a.json", Comments::refused);
  CHECK(numbers.dump() == "[8,-2000,8.5,1e+300,9007199254740992,18446744073709551615]");
}

TEST_CASE("A syntax error names line and column") {
  CHECK_THAT(error_of("{\n  \"a\": 1,\n  \"b\" 2\n}"), StartsWith("a.json:3:7: not valid JSON"));
  CHECK_THAT(error_of("{\"a\": NaN}"), StartsWith("a.json:1:7: not valid JSON"));
  CHECK_THAT(error_of("[Infinity]"), StartsWith("a.json:1:2: not valid JSON"));
  CHECK_THAT(error_of("[1, 1e999]"), StartsWith("a.json:1:9: number too large"));
  CHECK_THAT(error_of(""), StartsWith("a.json:1:1: not valid JSON"));
  CHECK_THAT(error_of("{} x"), StartsWith("a.json:1:4: not valid JSON"));
  CHECK_THAT(error_of("// no\n{}"), StartsWith("a.json:1:1: not valid JSON"));
  CHECK_THAT(error_of("\"\xff\""), StartsWith("a.json:1:2: not valid JSON"));
}

TEST_CASE("A doubled key is named with its place") {
  CHECK_THAT(error_of(R"({"a": [{"b": 1}, {"c": {}, "c": 2}]})"),
             Equals("a.json: /a/1: key \"c\" appears twice"));
  CHECK_THAT(error_of(R"({"a": 1, "a": 1})"), Equals("a.json: key \"a\" appears twice"));
  CHECK_NOTHROW(parse_json(R"([{"a": 1}, {"a": 1}])", "a.json", Comments::refused));
}

TEST_CASE("Nesting has a limit") {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK_NOTHROW(parse_json(nested(64), "a.json", Comments::refused));
  CHECK_THAT(error_of(nested(65)), Equals("a.json: nested too deep, expected at most 64 levels"));
  CHECK_THAT(error_of(std::string(5'000'000, '[')),
             Equals("a.json: nested too deep, expected at most 64 levels"));
}
