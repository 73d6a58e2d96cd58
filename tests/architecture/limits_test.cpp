// The table of docs/limits.md says what the code holds to.

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <vector>

namespace {

std::string text_in_repository(const std::string &file) {
  std::ifstream in(PMDSIM_SOURCE_DIR "/" + file);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct LimitRow {
  std::string limit, file, name;
};

std::vector<LimitRow> limit_rows() {
  static const std::regex row(R"(\| [^|]+ \| ([^|]+) \| `([^`]+)`: `([^`]+)` \|)");
  const std::string text = text_in_repository("docs/limits.md");
  std::vector<LimitRow> rows;
  for (std::sregex_iterator found(text.begin(), text.end(), row), end; found != end; ++found)
    rows.push_back({(*found)[1], (*found)[2], (*found)[3]});
  return rows;
}

// "2^22 (4 MiB)", "100000".
double limit_of(const std::string &text) {
  const std::size_t power = text.find('^');
  return power == text.npos ? std::stod(text) : std::pow(std::stod(text), std::stod(text.substr(power + 1)));
}

// What follows "NAME = " in a source: "std::size_t{1} << 22", "100'000".
std::optional<double> constant_in(const std::string &source, const std::string &name) {
  std::smatch found;
  if (!std::regex_search(source, found, std::regex("\\b" + name + " = ([^;,]+)[;,]")))
    return std::nullopt;
  std::string value =
      std::regex_replace(found[1].str(), std::regex("'|std::u?int\\d+_t|std::size_t|[{}u]"), "");
  const std::size_t shift = value.find("<<");
  return shift == value.npos ? std::stod(value)
                             : std::ldexp(std::stod(value), std::stoi(value.substr(shift + 2)));
}

std::optional<double> limit_in(const LimitRow &row) {
  const std::string text = text_in_repository(row.file);
  if (!row.file.ends_with(".json"))
    return constant_in(text, row.name);
  return nlohmann::json::parse(text).at(nlohmann::json::json_pointer(row.name)).get<double>();
}

} // namespace

TEST_CASE("the limits that are told are those that the code has") {
  const std::vector<LimitRow> rows = limit_rows();
  CHECK(rows.size() > 30);
  for (const LimitRow &row : rows) {
    INFO(row.file << ": " << row.name);
    const std::optional<double> held = limit_in(row);
    REQUIRE(held);
    CHECK(*held == limit_of(row.limit));
  }
}
