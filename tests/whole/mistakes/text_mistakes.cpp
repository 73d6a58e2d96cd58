// Mistakes in how JSON is written.

#include "tests/program/program.h"
#include "tests/whole/mistakes/mistakes.h"

namespace pmdsim::test {
namespace {

Mistake setup_text(const std::string &what, const std::string &text, const std::vector<std::string> &told,
                   const std::string &remedy, int exit_code = 3) {
  return {what, {"check", "setup.json"}, {{"setup.json", text}}, exit_code, told, remedy};
}

Mistake rewritten(const std::string &what, const std::string &from, const std::string &to,
                  const std::vector<std::string> &told, const std::string &remedy) {
  return setup_text(what, with(good_setup(), from, to), told, remedy);
}

std::string replaced(std::string text, const std::string &from, const std::string &to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string utf16(const std::string &text) {
  std::string result = "\xff\xfe";
  for (const char letter : text)
    result += std::string{letter, '\0'};
  return result;
}

} // namespace

Mistakes text_mistakes() {
  const std::string good = good_setup();
  return {
      "How JSON is written",
      {rewritten("no comma between two keys", "0.0018,", "0.0018",
                 {"setup.json:7:29:", "expected a comma before \"modulation_hz\""},
                 "A comma at the end of line 7"),
       rewritten("a comma behind the last key", "[20e6]\n", "[20e6],\n",
                 {"setup.json:8:28:", "expected no comma before }"}, "No comma there"),
       rewritten("a comma behind the last value", "[8, 8]", "[8, 8,]",
                 {"setup.json:5:24:", "expected no comma before ]"}, "No comma there"),
       rewritten("single quotes", "\"pmd\",", "'pmd',", {"setup.json:4:13:", "double quotes"}, "`\"pmd\"`"),
       rewritten("a key without quotes", "\"name\": \"pmd\"", "name: \"pmd\"",
                 {"setup.json:4:5:", "a key in double quotes", "name"}, "`\"name\"`"),
       rewritten("typographic quotes", "\"pmd\",", "\xe2\x80\x9cpmd\xe2\x80\x9d,",
                 {"setup.json:4:13:", "straight double quotes"}, "A text editor, no text program"),
       rewritten("`=` in place of `:`", "\"name\": \"pmd\"", "\"name\" = \"pmd\"",
                 {"setup.json:4:12:", "a colon after the key \"name\""}, "`\"name\": \"pmd\"`"),
       rewritten("`# comment`", "\"pmd\",", "\"pmd\", # mine", {"setup.json:4:20:", "begin with //"},
                 "`// comment`"),
       rewritten("`True`", "0.0018", "True", {"setup.json:7:23:", "expected true"}, "Small letters"),
       rewritten("`.0018`", "0.0018", ".0018", {"setup.json:7:23:", "a digit before the point"}, "`0.0018`"),
       rewritten("`+0.0018`", "0.0018", "+0.0018", {"setup.json:7:23:", "without +"}, "`0.0018`"),
       rewritten("`0,0018`", "0.0018", "0,0018", {"setup.json:7:25:", "decimals have a point"}, "`0.0018`"),
       rewritten("`[20 MHz]`", "[20e6]", "[20 MHz]", {"setup.json:8:26:", "a number has no unit"},
                 "`[20e6]`"),
       rewritten("`NaN`", "0.0018", "NaN", {"setup.json:7:23:", "a finite number"}, "A number"),
       rewritten("a backslash in text", "wall.gltf", "scenes\\wall.gltf",
                 {"setup.json:2:19:", "expected / in paths"}, "`parts/wall.gltf`"),
       rewritten("text that is not closed", "\"pmd\",", "\"pmd,",
                 {"setup.json:4:13:", "a double quote at the end"}, "`\"pmd\"`"),
       setup_text("the last brackets are missing", good.substr(0, good.rfind("  }]")),
                  {"setup.json:15:1:", "expected } for the { of line 10"}, "Close what is open"),
       setup_text("a bracket too many", good + "}\n", {"setup.json:17:1:", "the end of the file"},
                  "One fewer"),
       rewritten("`}` for `]`", "[8, 8]", "[8, 8}", {"setup.json:5:24:", "] for the [ of line 5"}, "`]`"),
       rewritten("a key twice", "\"name\": \"pmd\",", "\"name\": \"pmd\", \"name\": \"a\",",
                 {"setup.json:4:20: /sensors/0:", "\"name\" appears twice", "first in line 4"},
                 "One of them"),
       setup_text("an empty file", "", {"setup.json", "is empty"}, "A setup in it"),
       setup_text("UTF-16, as some editors save it", utf16(good),
                  {"setup.json:1:1:", "save the file as UTF-8"}, "UTF-8"),
       setup_text("Latin-1 letters", with(good, "\"pmd\"", "\"Ger\xe4t\""),
                  {"setup.json:4:", "save the file as UTF-8"}, "UTF-8"),
       setup_text("UTF-8 with a byte order mark", "\xef\xbb\xbf" + good, {}, "Nothing, it is read", 0),
       setup_text("line ends of Windows", replaced(good, "\n", "\r\n"), {}, "Nothing, they are read", 0),
       setup_text("tabs in place of blanks", replaced(good, "  ", "\t"), {}, "Nothing, they are read", 0),
       setup_text("comments", "// mine\n" + with(good, "8]", "8 /* rows */]"), {},
                  "Nothing, they are skipped", 0)}};
}

} // namespace pmdsim::test
