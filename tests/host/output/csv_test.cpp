// Tables as CSV.

#include "host/output/tables/csv.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using nlohmann::ordered_json;

TEST_CASE("a row's objects are columns, null is nothing, and quotes are doubled") {
  const ordered_json rows = {
      {{"name", "a \"b\", c"}, {"length_m", 0.1}, {"parts", {{"x", 1}, {"y", nullptr}}}, {"full", true}},
      {{"name", "d"}, {"length_m", 1e-9}, {"parts", {{"x", 2}, {"y", 3}}}, {"full", false}}};
  CHECK(csv_text(rows) == "name,length_m,parts.x,parts.y,full\n"
                          "\"a \"\"b\"\", c\",0.1,1,,true\n"
                          "\"d\",1e-09,2,3,false\n");
  CHECK(csv_text(ordered_json::array()).empty());
  CHECK(csv_text({{{"a", 1}}, {{"a", 2}, {"b,c", 3}}, {{"b,c", 4}}}) == "a,\"b,c\"\n1,\n2,3\n,4\n");
}
