// The table of results of variants, from records that others may have written.

#include "host/capture/variant_table.h"

#include <catch2/catch.hpp>

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
