// What is near to what was written, and what is not.

#include "host/input/words/near_name.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

const std::vector<std::string> keys{"focal_length_m", "focus_distance_m", "modulation_hz", "samples", "taps"};

} // namespace

TEST_CASE("Edits are letters put in, left out, replaced and swapped, whatever their case") {
  CHECK(edits_between("", "") == 0);
  CHECK(edits_between("taps", "") == 4);
  CHECK(edits_between("taps", "Taps") == 0);
  CHECK(edits_between("tapps", "taps") == 1);
  CHECK(edits_between("tas", "taps") == 1);
  CHECK(edits_between("tabs", "taps") == 1);
  CHECK(edits_between("tpas", "taps") == 1);
  CHECK(edits_between("kitten", "sitting") == 3);
  CHECK(edits_between("ca", "abc") == 3); // of optimal string alignment, which edits nothing twice
}

TEST_CASE("The nearest name is one within a third of the letters, or that begins alike") {
  CHECK(nearest_name("sampels", keys) == "samples");
  CHECK(nearest_name("focal_lenght", keys) == "focal_length_m");
  CHECK(nearest_name("Modulation_Hz", keys) == "modulation_hz");
  CHECK(nearest_name("modulation", keys) == "modulation_hz");
  CHECK(nearest_name("samples_per_pixel", keys) == "samples");
  CHECK_FALSE(nearest_name("colour", keys));
  CHECK_FALSE(nearest_name("", keys));
  CHECK_FALSE(nearest_name("p1", std::vector<std::string>{"k1", "k2"}));
  CHECK_FALSE(nearest_name("a", {}));
  CHECK_FALSE(nearest_name(std::string(1'000'000, 'a'), keys));
}

TEST_CASE("Names in a message are in quotes, and no more than fit a line") {
  CHECK(did_you_mean("tabs", keys) == ", did you mean \"taps\"?");
  CHECK(did_you_mean("colour", keys).empty());
  CHECK(listed_names(std::vector<std::string>{"a"}) == "\"a\"");
  CHECK(listed_names(std::vector<std::string>{"a", "b", "c"}) == "\"a\", \"b\" or \"c\"");
  const std::string many = listed_names(std::vector<std::string>(1000, "name"));
  CHECK(many.ends_with(" more"));
  CHECK(many.size() < 250);
}
