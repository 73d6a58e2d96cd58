// The rows of channels against what else lists them: the shader that stores them, and the documents.

#include "engine/model/channel_names.h"
#include "engine/model/channels.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

using namespace pmdsim;

namespace {

namespace fs = std::filesystem;

const fs::path root = fs::path(PMDSIM_SCENES).parent_path();

std::vector<std::string> lines_of(const fs::path &file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);)
    lines.push_back(line);
  return lines;
}

// "const uint channel_NAME = N;" of the shader.
std::map<std::string, std::uint32_t> slots_of_shader() {
  static const std::regex constant(R"(^const uint channel_(\w+) = (\d+);.*)");
  std::map<std::string, std::uint32_t> slots;
  std::smatch match;
  for (const std::string &line : lines_of(root / "shaders/signal/demodulation.glsl"))
    if (std::regex_match(line, match, constant))
      slots[match[1]] = static_cast<std::uint32_t>(std::stoul(match[2]));
  return slots;
}

// The rows of the table of channels.
std::vector<std::string> documented_rows() {
  std::vector<std::string> rows;
  bool inside = false;
  for (const std::string &line : lines_of(root / "docs" / "outputs.md")) {
    inside = line.starts_with("| channel | unit |") || (inside && line.starts_with("|"));
    if (inside && line.starts_with("| `"))
      rows.push_back(line);
  }
  return rows;
}

bool is_id(const ChannelRow &row) {
  return std::holds_alternative<std::vector<std::uint32_t> Measurement::*>(row.at) && row.name != "unwrap_ok";
}

std::string documented(const ChannelRow &row) {
  const std::string name(row.name);
  const std::string names = is_of_taps(row) ? "`" + name + "0`, `" + name + "1`, ..." : "`" + name + "`";
  const std::string unit = row.unit.empty() ? is_id(row) ? "" : "1 " : std::string(row.unit) + ' ';
  return "| " + names + " | " + unit + "| " + std::string(row.about) + " |";
}

} // namespace

TEST_CASE("the shader stores each channel in its row's slot") {
  const std::map<std::string, std::uint32_t> slots = slots_of_shader();
  std::size_t found = 0;
  for (const ChannelRow &row : channel_rows) {
    using Area = DeviceSlot::Area;
    if (row.slot.area != Area::truth && row.slot.area != Area::frequency)
      continue; // the shader is told its place, counts it from the taps, or does not know it
    INFO("channel_" << row.name);
    const auto slot = slots.find(std::string(row.name));
    REQUIRE(slot != slots.end());
    CHECK(slot->second == row.slot.index);
    ++found;
  }
  CHECK(found == slots.size());
}

TEST_CASE("the documents list the channels as their rows say") {
  std::vector<std::string> expected;
  for (const ChannelRow &row : channel_rows)
    expected.push_back(documented(row));
  CHECK(documented_rows() == expected);
}

TEST_CASE("the name of a rest tells the channel that it belongs to") {
  for (const auto &[name, rest] : {std::pair("distance_m", "distance_rest_m"),
                                   {"f1.direct_distance_m", "f1.direct_distance_rest_m"},
                                   {"distance_m_noiseless", "distance_rest_m_noiseless"},
                                   {"deformation_mm", "deformation_rest_mm"}}) {
    CHECK(rest_name(name) == rest);
    CHECK(name_of_rest(rest) == name);
    CHECK(name_of_rest(name) == std::nullopt);
  }
  CHECK(name_of_rest("crest_m") == std::nullopt);
  CHECK(name_of_rest("_rest") == "");
  for (const ChannelRow &row : channel_rows)
    CHECK(name_of_rest(row.name) == std::nullopt);
}

TEST_CASE("pictures are of floats and ids, and names differ") {
  for (const ChannelRow &row : channel_rows) {
    INFO(row.name);
    CHECK_FALSE((row.preview && is_of_taps(row)));
    if (row.preview)
      CHECK(is_id(row) == (row.preview->scale == ColourScale::category));
    CHECK(std::ranges::count(channel_rows, row.name, &ChannelRow::name) == 1);
    CHECK(&row_of(row.at) == &row);
  }
}
