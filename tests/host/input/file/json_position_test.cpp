// Places of values in JSON text, beside those that nlohmann's parser tells.

#include "host/input/file/input_error.h"
#include "host/input/file/json_file.h"
#include "host/input/file/json_position.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <random>

using namespace pmdsim;
using nlohmann::json;

namespace {

// "LINE:COLUMN" of the value, behind a slash that of its key.
std::string place(const std::string &text, const std::string &pointer, int occurrence = 1) {
  const auto found = position_in_json(text, json::json_pointer(pointer), occurrence);
  if (!found)
    return "nowhere";
  const TextPlace value = text_place("", text, found->value), key = text_place("", text, found->key);
  return fmt::format("{}:{}/{}:{}", value.line, value.column, key.line, key.column);
}

// A random document, and its text with random blanks and comments.
json random_value(std::mt19937 &random, int depth, std::string &text) {
  const std::vector<std::string> blanks{"", " ", "\n", "\r\n\t", " // a \"{[\n", "/* ,:]}\n\" */"};
  const auto blank = [&] { text += blanks[random() % blanks.size()]; };
  const std::size_t members = random() % 4;
  switch (depth == 0 ? 2 + random() % 3 : random() % 5) {
  case 0: {
    json object = json::object();
    text += '{';
    for (std::size_t i = 0; i < members; ++i) {
      const json key = fmt::format("k\"\\{}/~\u00e4", i);
      text += i == 0 ? "" : ",", blank(), text += key.dump(), blank(), text += ':', blank();
      object[key.get<std::string>()] = random_value(random, depth - 1, text);
      blank();
    }
    text += '}';
    return object;
  }
  case 1: {
    json array = json::array();
    text += '[';
    for (std::size_t i = 0; i < members; ++i) {
      text += i == 0 ? "" : ",", blank();
      array.push_back(random_value(random, depth - 1, text));
      blank();
    }
    text += ']';
    return array;
  }
  case 2:
    text += "-1.5e3";
    return -1500;
  case 3:
    text += "\"\\\"]}// \\\\\"";
    return "\"]}// \\";
  default:
    text += "null";
    return nullptr;
  }
}

// Every value of the document is found where its text begins.
void check_all(const std::string &text, const json &value, const json::json_pointer &pointer) {
  const auto found = position_in_json(text, pointer);
  REQUIRE(found);
  const std::string begin = value.is_object()   ? "{"
                            : value.is_array()  ? "["
                            : value.is_string() ? "\""
                            : value.is_null()   ? "null"
                                                : "-1.5e3";
  CHECK(text.substr(found->value, begin.size()) == begin);
  if (value.is_object())
    for (const auto &[key, member] : value.items()) {
      const auto of_member = position_in_json(text, pointer / key);
      REQUIRE(of_member);
      CHECK(text.substr(of_member->key, json(key).dump().size()) == json(key).dump());
      check_all(text, member, pointer / key);
    }
  if (value.is_array())
    for (std::size_t i = 0; i < value.size(); ++i)
      check_all(text, value[i], pointer / i);
}

} // namespace

TEST_CASE("Values and keys are found by line and column") {
  const std::string text = "{\n  \"a\": 1, // one\n  \"b\": [true, {\"c\": \"x\"}],\n\t\"d\":{}\n}";
  CHECK(place(text, "") == "1:1/1:1");
  CHECK(place(text, "/a") == "2:8/2:3");
  CHECK(place(text, "/b") == "3:8/3:3");
  CHECK(place(text, "/b/0") == "3:9/3:9");
  CHECK(place(text, "/b/1/c") == "3:21/3:16");
  CHECK(place(text, "/d") == "4:6/4:2");
  for (const char *absent : {"/e", "/a/0", "/b/2", "/b/c", "/d/x"})
    CHECK(place(text, absent) == "nowhere");
}

TEST_CASE("Columns count characters, not bytes, nor the byte order mark") {
  CHECK(place("{\"\u00e4\u20ac\": 1}", "/\u00e4\u20ac") == "1:8/1:2");
  CHECK(place("\xef\xbb\xbf{\"a\": 1}", "/a") == "1:7/1:2");
  CHECK(place("{\r\n  \"a\": 1\r\n}", "/a") == "2:8/2:3");
}

TEST_CASE("The second of two keys is found") {
  CHECK(place("{\"a\": {\"a\": 1},\n \"a\": 2", "/a", 2) == "2:7/2:2");
  CHECK(place("{\"a\": 1}", "/a", 2) == "nowhere");
}

TEST_CASE("Every value of random documents is found") {
  std::mt19937 random(20261127);
  for (int i = 0; i < 300; ++i) {
    std::string text;
    const json document = random_value(random, 4, text);
    INFO(text);
    REQUIRE(parse_json(text, "a.json", Comments::allowed) == document);
    check_all(text, document, json::json_pointer());
  }
}

TEST_CASE("Errors of changed values say who changed them") {
  JsonSource source{std::make_shared<const std::string>("{\"a\": {\"b\": 1}}"),
                    {{"/a/c", "--set"}, {"/d", ""}, {"/e/f", "x:1"}}};
  const Place root{.file = "s.json", .source = std::make_shared<const JsonSource>(source)};
  const auto text = [](const Error &error) { return std::string(error.what()); };
  CHECK(text(input_error(root / "a" / "b", "no")) == "s.json:1:13: /a/b: no");
  CHECK(text(input_error(root / "a" / "x", "no")) == "s.json:1:7: /a/x: no");
  CHECK(text(input_error(root / "a" / "c", "no")) == "s.json: /a/c (by --set): no");
  CHECK(text(input_error(root / "a" / "c" / 0, "no")) == "s.json: /a/c/0 (by --set): no");
  CHECK(text(input_error(root / "d", "no")) == "s.json: /d: no");
  CHECK(text(input_error(root / "e", "no")) == "s.json: /e (by x:1): no");
  CHECK(text(key_error(root / "a", "b", "no")) == "s.json:1:8: /a: no");
  CHECK(text(key_error(root / "a", "c", "no")) == "s.json: /a (by --set): no");
  CHECK(text(input_error(root, "no")) == "s.json:1:1: no");
  CHECK(input_error(root / "a" / "b", "no").where().place == "/a/b");
}
