// docs/warnings.md explains the warnings that there are, and no others, in the words of the code.

#include "engine/model/warning.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <regex>
#include <string>
#include <utility>
#include <vector>

using pmdsim::warning_kinds;
using pmdsim::WarningKind;

namespace {

using Row = std::pair<std::string, std::string>;

std::vector<Row> rows_of_document() {
  std::ifstream in(PMDSIM_SOURCE_DIR "/docs/warnings.md");
  const std::regex row(R"(\| `([a-z0-9-]+)` \| ([^|]+) \| ([^|]+) \|)");
  std::vector<Row> rows;
  std::smatch parts;
  for (std::string line; std::getline(in, line);)
    if (std::regex_match(line, parts, row))
      rows.emplace_back(parts[1], parts[2]);
  return rows;
}

} // namespace

TEST_CASE("docs/warnings.md has every warning that there is") {
  std::vector<Row> kinds;
  for (const WarningKind &kind : warning_kinds)
    kinds.emplace_back(kind.code, kind.means);
  CHECK(rows_of_document() == kinds);
}

TEST_CASE("Warnings stand in the order of their codes, each once, and their codes are words") {
  const std::regex word("[a-z0-9]+(-[a-z0-9]+)*");
  for (std::size_t i = 0; i < warning_kinds.size(); ++i) {
    INFO(warning_kinds[i].code);
    CHECK(std::regex_match(std::string(warning_kinds[i].code), word));
    CHECK((i == 0 || warning_kinds[i - 1].code < warning_kinds[i].code));
    CHECK(warning_kinds[i].means.ends_with('.'));
  }
}
