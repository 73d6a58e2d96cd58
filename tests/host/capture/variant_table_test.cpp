// Variants from strangers' files, and the table of their results from records that others may have written.

#include "host/capture/variant_table.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using nlohmann::json;
using nlohmann::ordered_json;

TEST_CASE("what a record tells of a frame is beside what the row says, and never in its place") {
  const Variant variant{"0003", {}, json{{"sensors/0/taps", 8}}};
  VariantTable table({variant});
  const ordered_json manifest{{"sensor", "pmd"}, {"frame", 7}, {"time_s", 0.5}, {"error_claimed_m", nullptr}};
  table.add(variant, {{"manifest", manifest},
                      {"told",
                       {{"variant", 1},
                        {"sensor", json::array()},
                        {"frame", 3.5e38},
                        {"sensors/0/taps", 9},
                        {"distance_min_m", 1.25},
                        {"amplitude_median", "high"}}}});
  const std::string text = table.text();
  INFO(text);
  const std::string row = text.substr(text.find('\n') + 1);
  CHECK(row.starts_with("0003 "));
  CHECK(row.find(" 7 ") != std::string::npos);
  CHECK(row.find("1.25") != std::string::npos);
  CHECK(row.find("\"high\"\n") != std::string::npos);
}

TEST_CASE("a change that has the name of one of the row's own keys takes none's place") {
  const Variant variant{"0000", {}, json{{"variant", nullptr}, {"sensor", nullptr}, {"frame", "x"}}};
  VariantTable table({variant});
  table.add(variant,
            {{"manifest", {{"sensor", "pmd"}, {"frame", 7}, {"time_s", 0.5}, {"error_claimed_m", 0.1}}}});
  const std::string row = table.text().substr(table.text().find('\n') + 1);
  CHECK(row.starts_with("0000 "));
  CHECK(row.find(" pmd ") != std::string::npos);
  CHECK(row.find(" 7 ") != std::string::npos);
}

TEST_CASE("setups whose names are other folders' name none of their frames") {
  CHECK(frames_folder_of("scenes/wall.json") == "wall");
  CHECK_THROWS_WITH(frames_folder_of("...\xc5"), Catch::StartsWith("...?: expected a setup with a name"));
  for (const char *file : {"...json", "scenes/...json", "..json"})
    CHECK_THROWS_WITH(frames_folder_of(file),
                      Catch::StartsWith(file) && Catch::Contains("the folder of its frames"));
}

TEST_CASE("the table that people read has no control characters of a record") {
  const Variant variant{"0000", {}, json::object()};
  VariantTable table({variant});
  const ordered_json manifest{
      {"sensor", "\x1b[2J\xc2\x9b"}, {"frame", 0}, {"time_s", 0.0}, {"error_claimed_m", nullptr}};
  table.add(variant, {{"manifest", manifest}, {"told", {{"distance_min_m", "\x7f\xc2\x9b"}}}});
  for (const char *character : {"\x1b", "\x7f", "\xc2\x9b"})
    CHECK(table.text().find(character) == std::string::npos);
}

TEST_CASE("all variants of a file change so many paths at most") {
  const test::TemporaryFolder folder;
  std::string lines;
  for (int i = 0; i < 1024; ++i)
    lines += fmt::format("{{\"a{}\": 1}}\n", i);
  CHECK(read_variants(folder.write("variants.jsonl", lines + lines)).size() == 2048);
  CHECK_THROWS_WITH(read_variants(folder.write("variants.jsonl", lines + "{\"b\": 1}\n")),
                    Catch::EndsWith("variants.jsonl:1025: expected at most 1024 paths in all variants"));
}
