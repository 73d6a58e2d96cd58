// The JSON of runs, as others may have left it: what no run has is refused before it is read.

#include "host/output/run/run_json.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;

namespace {

std::string object_of(std::size_t keys) {
  std::string text = "{";
  for (std::size_t i = 0; i < keys; ++i)
    text += fmt::format("{}\"a,{}\": [1, 2]", i == 0 ? "" : ", ", i);
  return text + "}";
}

} // namespace

TEST_CASE("objects of a run's files have so many keys at most, and lists any number of objects") {
  CHECK(parsed_in_order(object_of(4096), "run.json").value().size() == 4096);
  CHECK_FALSE(parsed_in_order(object_of(4097), "run.json"));
  std::string list = "[{}";
  for (std::size_t i = 1; i < 5000; ++i)
    list += ", {\"b\": 1, \"c\": 2}";
  CHECK(parsed_in_order(list + "]", "run.json").value().size() == 5000);
  CHECK_FALSE(parsed_in_order("[" + object_of(4097) + "]", "run.json"));
}
