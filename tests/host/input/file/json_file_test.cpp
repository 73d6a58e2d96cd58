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
  const auto numbers = parse_json("[8.0, -2e3, 8.5, 1e300, 9007199254740992.0, 9223372036854775807]",
                                  "a.json", Comments::refused);
  CHECK(numbers.dump() == "[8,-2000,8.5,1e+300,9007199254740992,9223372036854775807]");
}

TEST_CASE("An integer beyond 64 bits with a sign is a double, so that no bound takes it for a negative one") {
  const auto numbers =
      parse_json(R"({"a": [18446744073709551615, {"b": 9223372036854775808}]})", "a.json", Comments::refused);
  CHECK(numbers["a"][0].is_number_float());
  CHECK(numbers["a"][0] == 18446744073709551616.0);
  CHECK(numbers["a"][1]["b"] == 9223372036854775808.0);
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

TEST_CASE("A syntax error says what was expected, in place of what") {
  const auto says = [](const std::string &text, const std::string &message) {
    INFO(text);
    CHECK(error_of(text, Comments::allowed) == "a.json:" + message);
  };
  says("{\"a\": 1,}", "1:8: not valid JSON, expected no comma before }, found one");
  says("[1,\n]", "1:3: not valid JSON, expected no comma before ], found one");
  says("[1,,2]", "1:4: not valid JSON, expected one comma, found two");
  says("{\"a\": 1\n\"b\": 2}", "1:8: not valid JSON, expected a comma before \"b\", found none");
  says("['a']", "1:2: not valid JSON, expected text in double quotes, found a single quote");
  says("{a: 1}", "1:2: not valid JSON, expected a key in double quotes, found a");
  says("{\"a\" = 1}", "1:6: not valid JSON, expected a colon after the key \"a\", found =");
  says("{\"a\"}", "1:5: not valid JSON, expected a colon after the key \"a\", found }");
  says("{\"a\": }", "1:7: not valid JSON, expected a value, found }");
  says("[True]", "1:2: not valid JSON, expected true, found \"True\"");
  says("[None]", "1:2: not valid JSON, expected null, found \"None\"");
  says("[-Infinity]", "1:2: not valid JSON, expected a finite number, found \"-Infinity\"");
  says("[.5]", "1:2: not valid JSON, expected a digit before the point, as 0.5, found \".5\"");
  says("[5.]", "1:2: not valid JSON, expected a digit after the point, as 5.0, found \"5.\"");
  says("[+5]", "1:2: not valid JSON, expected a number without +, found \"+5\"");
  says("[007]", "1:2: not valid JSON, expected a number without leading zeros, found \"007\"");
  says("[0x1f]", "1:2: not valid JSON, expected a decimal number, found \"0x1f\"");
  says("[20MHz]", "1:2: not valid JSON, expected a number alone, without a unit, found \"20MHz\"");
  says("[1 # one\n]", "1:4: not valid JSON, expected a comment to begin with //, found #");
  says("[1 /* one", "1:4: not valid JSON, expected */ at the end of the comment, found none");
  says("{\n\"a\": [1\n}", "3:1: not valid JSON, expected ] for the [ of line 2, found }");
  says("{\"a\": [1]", "1:10: not valid JSON, expected } for the { of line 1, found the end of the file");
  says("[1]]", "1:4: not valid JSON, expected the end of the file after the last bracket, found ]");
  says("[\"a]",
       "1:2: not valid JSON, expected a double quote at the end of the text in the same line, found none");
  says("[\"a\tb\"]", "1:4: not valid JSON, expected \\t in text, found a tab");
  says("[\"C:\\scene\"]", "1:5: not valid JSON, expected / in paths, or \\\\ for a backslash, found \\s");
  says("[\"\u00e4\", oops]",
       "1:7: not valid JSON, expected text in double quotes, a number, true, false or null, found \"oops\"");
}

TEST_CASE("Whatever is cut off or put in is told in one line, at a place within the text") {
  const std::string good = "{\"a\": [1, -2.5e3, \"x\\n\", {\"b\": null}], // c\n \"d\": true}";
  for (std::size_t i = 0; i <= good.size(); ++i) {
    const std::string before = good.substr(0, i), after = good.substr(i);
    for (const char *more : {"{", "]", ",", ":", "\"", "'", "x", "/", "\\", "\xff", "\t"})
      for (const std::string &text : {before, before + more, before + more + after}) {
        INFO(text);
        try {
          parse_json(text, "a.json", Comments::allowed);
        } catch (const Error &error) {
          const std::string message = error.what();
          CHECK(message.starts_with("a.json:"));
          CHECK(message.find('\n') == message.npos);
          CHECK(message != "a.json:1:1: not valid JSON");
        }
      }
  }
}

TEST_CASE("A doubled key is named with its place") {
  CHECK_THAT(error_of(R"({"a": [{"b": 1}, {"c": {}, "c": 2}]})"),
             Equals("a.json:1:28: /a/1: key \"c\" appears twice, first in line 1"));
  CHECK_THAT(error_of(R"({"a": 1, "a": 1})"),
             Equals("a.json:1:10: key \"a\" appears twice, first in line 1"));
  CHECK_NOTHROW(parse_json(R"([{"a": 1}, {"a": 1}])", "a.json", Comments::refused));
}

TEST_CASE("Nesting has a limit") {
  const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  CHECK_NOTHROW(parse_json(nested(64), "a.json", Comments::refused));
  CHECK_THAT(error_of(nested(65)), Equals("a.json: nested too deep, expected at most 64 levels"));
  CHECK_THAT(error_of(std::string(5'000'000, '[')),
             Equals("a.json: nested too deep, expected at most 64 levels"));
}
