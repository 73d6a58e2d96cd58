// A stranger enters by the documents: the files and sections that they and the comments name exist, and the
// pages that everybody reads first stay short.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path repository = PMDSIM_SOURCE_DIR;
constexpr std::ptrdiff_t most_lines = 150, most_terms = 25;

std::string text_of(const fs::path &file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> documents() {
  std::vector<fs::path> found;
  for (const fs::path &folder : {repository, repository / "docs"})
    for (const auto &entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".md")
        found.push_back(entry.path());
  return found;
}

const std::vector<fs::path> &sources() {
  static const std::vector<fs::path> found = [] {
    const std::set<std::string> extensions{".h", ".cpp", ".glsl", ".comp", ".vert", ".frag"};
    std::vector<fs::path> files;
    for (const char *folder : {"engine", "host", "shaders", "tests"})
      for (const auto &entry : fs::recursive_directory_iterator(repository / folder))
        if (extensions.contains(entry.path().extension().string()))
          files.push_back(entry.path());
    return files;
  }();
  return found;
}

// The file's comments, those of lines that follow each other as one text: names may be cut by the end of a
// line. Slashes within a string or an address (http://) begin no comment.
std::string comments_of(const std::string &source) {
  std::string comments;
  std::size_t begin = 0;
  while (begin < source.size()) {
    const std::size_t end = std::min(source.find('\n', begin), source.size());
    const std::string line = source.substr(begin, end - begin);
    const std::size_t slashes = line.find("//");
    if (slashes != std::string::npos && std::ranges::count(line.substr(0, slashes), '"') % 2 == 0)
      comments += line.substr(slashes + 2);
    else
      comments += '\n';
    begin = end + 1;
  }
  return std::regex_replace(comments, std::regex(" +"), " ");
}

// All that `pattern` finds in the text, each match with its groups.
std::vector<std::smatch> matches(const std::string &text, const std::regex &pattern) {
  return {std::sregex_iterator(text.begin(), text.end(), pattern), std::sregex_iterator()};
}

bool is_base_name(const std::string &name) {
  static const std::set<std::string> names = [] {
    std::set<std::string> all;
    for (const auto &files : {sources(), documents()})
      for (const fs::path &file : files)
        all.insert(file.filename());
    return all;
  }();
  return names.contains(name);
}

// From the repository, from the folder of the file that says so, or a name alone, wherever it is.
bool exists(const std::string &name, const fs::path &folder) {
  return fs::exists(repository / name) || fs::exists(folder / name) ||
         (name.find('/') == std::string::npos && is_base_name(name));
}

// The names in a text that look like files or folders of ours and are none.
std::vector<std::string> missing_names(const std::string &text, const fs::path &folder) {
  static const std::regex in_our_rooms(
      R"((^|[^\w/.-])((engine|host|shaders|tests|docs|scenes|third_party)/[\w./-]*\w))");
  static const std::regex source_or_page(
      R"((^|[^\w/.*-])([\w-][\w./-]*\.(glsl|comp|vert|frag|h|cpp|md))(?!\w))");
  std::vector<std::string> missing;
  for (const std::regex *pattern : {&in_our_rooms, &source_or_page})
    for (const std::smatch &match : matches(text, *pattern))
      if (!exists(match[2], folder))
        missing.push_back(match[2]);
  return missing;
}

// The titles of a page's sections.
std::set<std::string> sections_of(const fs::path &page) {
  static const std::regex heading(R"((^|\n)#+ +([^\n]+))");
  const std::string text = text_of(page);
  std::set<std::string> titles;
  for (const std::smatch &match : matches(text, heading))
    titles.insert(match[2]);
  return titles;
}

// A title as links name it: in small letters, without punctuation, a dash for each space.
std::string anchor_of(const std::string &title) {
  std::string anchor;
  for (const char letter : title)
    if (std::isalnum(static_cast<unsigned char>(letter)) || letter == '-' || letter == '_')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    else if (letter == ' ')
      anchor += '-';
  return anchor;
}

// The references that name no section of ours: a page's name, a comma, and a section's title in quotes.
std::vector<std::string> missing_sections(const std::string &text) {
  static const std::regex section("([\\w./-]+\\.md)[,:]? \"([^\"]+)\"");
  std::vector<std::string> missing;
  for (const std::smatch &match : matches(text, section))
    if (!sections_of(repository / match[1].str()).contains(match[2]))
      missing.push_back(match[0]);
  return missing;
}

bool leads_somewhere(const std::string &target, const fs::path &page) {
  if (target.starts_with("http"))
    return true;
  const std::size_t hash = target.find('#');
  const fs::path file = hash == 0 ? page : page.parent_path() / target.substr(0, hash);
  if (!fs::exists(file))
    return false;
  return hash == std::string::npos || std::ranges::any_of(sections_of(file), [&](const std::string &title) {
           return anchor_of(title) == target.substr(hash + 1);
         });
}

std::vector<std::string> dead_links(const fs::path &page) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  const std::string text = text_of(page);
  std::vector<std::string> dead;
  for (const std::smatch &match : matches(text, link))
    if (!leads_somewhere(match[1], page))
      dead.push_back(match[1]);
  return dead;
}

// The names in texts like "`name` in `file`" that the file does not have.
std::vector<std::string> strangers(const std::string &text) {
  static const std::regex inside(R"(`(\w+)`\s+in\s+`([\w./-]+\.\w+)`)");
  std::vector<std::string> found;
  for (const std::smatch &match : matches(text, inside))
    if (text_of(repository / match[2].str()).find(match[1]) == std::string::npos)
      found.push_back(match[0]);
  return found;
}

std::ptrdiff_t lines_of(const char *page) {
  const std::string text = text_of(repository / page);
  return std::ranges::count(text, '\n');
}

} // namespace

TEST_CASE("documents name files and sections that exist") {
  CHECK(documents().size() > 10);
  for (const fs::path &page : documents()) {
    INFO(page);
    const std::string text = std::regex_replace(text_of(page), std::regex("\\s+"), " ");
    CHECK(missing_names(text, page.parent_path()) == std::vector<std::string>{});
    CHECK(missing_sections(text) == std::vector<std::string>{});
    CHECK(strangers(text) == std::vector<std::string>{});
    CHECK(dead_links(page) == std::vector<std::string>{});
  }
}

TEST_CASE("comments name files and sections that exist") {
  CHECK(sources().size() > 500);
  for (const fs::path &file : sources()) {
    INFO(file);
    const std::string comments = comments_of(text_of(file));
    CHECK(missing_names(comments, file.parent_path()) == std::vector<std::string>{});
    CHECK(missing_sections(comments) == std::vector<std::string>{});
  }
}

TEST_CASE("the pages that are read first are short") {
  CHECK(lines_of("README.md") <= most_lines);
  CHECK(lines_of("ARCHITECTURE.md") <= most_lines);
  const std::string glossary = text_of(repository / "docs" / "glossary.md");
  const std::string terms = glossary.substr(0, glossary.find("\n## "));
  const auto rows =
      std::ssize(matches(terms, std::regex(R"(\n\| )"))) - 1; // without the heads of the columns
  CHECK(rows > 0);
  CHECK(rows <= most_terms);
}

TEST_CASE("every page can be reached from the README") {
  const std::string readme = text_of(repository / "README.md");
  for (const fs::path &page : documents()) {
    const std::string name = fs::relative(page, repository);
    INFO(name);
    CHECK((name == "README.md" || readme.find("](" + name) != std::string::npos));
  }
}

TEST_CASE("a name that leads nowhere is noticed") {
  const fs::path folder = repository / "engine" / "light";
  CHECK(missing_names("`engine/light/tones.h`, tones.h, `tests/light` and tests/<room>", folder).empty());
  CHECK(missing_names("vulkan.hpp, *.cpp, build/release/tests/bench and engine/light.", folder).empty());
  CHECK(missing_names("see engine/light/no_such_room", folder).size() == 1);
  CHECK(missing_names("(no_such_file.glsl)", folder).size() == 1);
  CHECK(missing_names("no/such/tones.h", folder).size() == 1);
  CHECK(comments_of("int a; // one\n// two\nint b = \"//\";\n") == " one two\n");
  CHECK(missing_sections(R"(docs/theory.md, "Conventions")").empty());
  CHECK(missing_sections(R"(docs/theory.md, "No such section")").size() == 1);
  CHECK(missing_sections(R"(docs/no_such_page.md, "Conventions")").size() == 1);
  CHECK(anchor_of("Rounding: what keeps float32 honest") == "rounding-what-keeps-float32-honest");
  CHECK(leads_somewhere("docs/theory.md#conventions", repository / "README.md"));
  CHECK_FALSE(leads_somewhere("docs/theory.md#no-such-section", repository / "README.md"));
  CHECK_FALSE(leads_somewhere("theory.md", repository / "README.md"));
  CHECK(strangers("`see_path` in `shaders/light/sum.glsl`").empty());
  CHECK(strangers("`no_such_function` in `shaders/light/sum.glsl`").size() == 1);
}
