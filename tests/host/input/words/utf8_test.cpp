// Characters of UTF-8, and lines that show nothing but characters.

#include "host/input/words/utf8.h"

#include "host/input/file/json_file.h"
#include "tests/host/input/file/input_error_of.h"

#include <catch2/catch.hpp>
#include <string>

using namespace pmdsim;
using namespace pmdsim::test;

TEST_CASE("Characters of UTF-8 have one to four bytes") {
  CHECK(character_bytes("") == 0);
  CHECK(character_bytes("ab") == 1);
  CHECK(character_bytes("\u00e9x") == 2);
  CHECK(character_bytes("\u20acx") == 3);
  CHECK(character_bytes("\U0001f600x") == 4);
}

TEST_CASE("What is no UTF-8 has no character in front") {
  for (const char *text : {"\x80", "\xc3", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80",
                           "\xf8\x88\x80\x80\x80", "\xff", "\xe2\x82", "\xe2\x82\x28"}) {
    INFO(text);
    CHECK(character_bytes(text) == 0);
    CHECK_FALSE(is_utf8(text));
  }
  CHECK(is_utf8("\u00e9\u20ac\U0001f600"));
}

TEST_CASE("A line shows ? for control characters and for bytes that are no character") {
  CHECK(in_one_line("a\nb\tc\x7f") == "a?b?c?");
  CHECK(in_one_line("\u0085\u009b\u00a0") == "??\u00a0");
  CHECK(in_one_line("\xff\u00e9\xc3") == "?\u00e9?");
  CHECK(in_one_line("/home/\u00e9 \u20ac") == "/home/\u00e9 \u20ac");
}

TEST_CASE("Errors quote no bytes that are not UTF-8") {
  const auto error_of = [](const std::string &text) {
    return input_error_of([&] { parse_json(text, "a\xff.json", Comments::refused); });
  };
  CHECK(error_of("{\"a\" \xff}").ends_with("expected a colon after the key \"a\", found ?"));
  CHECK(is_utf8(error_of("{\"a\" \xff}")));
  CHECK(error_of("[1 \xc2\x9b]").ends_with("(a number has no unit), found ?"));
}
