// No two types of the project have one name in one namespace. Where two do, in sources that never meet, the
// linker takes one's inline functions for the other's too, and says nothing.

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path project_folder = PMDSIM_SOURCE_DIR;

// Types at the outermost level of a source that is formatted: "pmdsim::vulkan::Device". Those of namespaces
// without a name are the source's own.
std::vector<std::string> types_in(const fs::path &file) {
  static const std::regex begin(R"(namespace ([\w:]*) ?\{)"), end(R"(\} // namespace.*)"),
      type(R"((?:struct|class|enum class|union) (\w+)(?: final)?(?: : .*)? \{.*)");
  std::vector<std::string> namespaces, types;
  std::ifstream in(file);
  std::smatch match;
  for (std::string line; std::getline(in, line);)
    if (std::regex_match(line, match, begin)) {
      namespaces.push_back(match[1]);
    } else if (std::regex_match(line, end) && !namespaces.empty()) {
      namespaces.pop_back();
    } else if (std::regex_match(line, match, type)) {
      std::string name = match[1];
      bool is_own = false;
      for (auto i = namespaces.rbegin(); i != namespaces.rend(); ++i) {
        name = *i + "::" + name;
        is_own = is_own || i->empty();
      }
      if (!is_own)
        types.push_back(name);
    }
  return types;
}

} // namespace

TEST_CASE("no two types have one name") {
  std::map<std::string, std::string> file_of;
  for (const char *folder : {"engine", "host"})
    for (const auto &entry : fs::recursive_directory_iterator(project_folder / folder))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
        for (const std::string &type : types_in(entry.path())) {
          const std::string file = fs::relative(entry.path(), project_folder);
          const auto [known, is_new] = file_of.try_emplace(type, file);
          INFO(type << " of " << known->second << " and of " << file);
          CHECK((is_new || known->second == file)); // one file may choose among several
        }
  CHECK(file_of.size() > 300);
}
