// Every channel that a frame may have has words for readers.

#include "engine/model/channels.h"
#include "host/output/page/channel_words.h"

#include <catch2/catch.hpp>
#include <set>

using namespace pmdsim;

TEST_CASE("every channel has a title of its own, a group and a line about it") {
  std::set<std::string> titles;
  for (const ChannelRow &row : channel_rows) {
    const std::string name = std::string(row.name) + (is_of_taps(row) ? "3" : "");
    INFO(name);
    const ChannelWords words = words_of(name, false);
    CHECK(words.group != "More");
    CHECK(words.title.find('_') == std::string::npos);
    CHECK(titles.insert(words.title).second);
    CHECK(words.about == row.about);
    CHECK((words.rank == ChannelRank::raw) == is_of_taps(row));
  }
}

TEST_CASE("a name is taken apart") {
  const ChannelWords tap = words_of("f1.tap_a_dn12", false);
  CHECK(tap.quantity == "tap_a_dn12");
  CHECK(tap.frequency == std::optional<std::size_t>(1));
  CHECK(tap.title == "numbers of tap A, image 12");
  CHECK(tap.rank == ChannelRank::raw);
  const ChannelWords deformed = words_of("f2.deformation_mm", false);
  CHECK(deformed.title == "deformation");
  CHECK(deformed.frequency == std::optional<std::size_t>(2));
  CHECK(deformed.at < words_of("f2.distance_m", false).at);
}

TEST_CASE("scales follow what the values are") {
  CHECK(words_of("distance_m", false).scale == PageScale::sequential);
  CHECK(words_of("multipath_m", false).scale == PageScale::zero_centred);
  CHECK(words_of("direct_phase_rad", false).scale == PageScale::turn);
  CHECK(words_of("lit", false).scale == PageScale::share);
  CHECK(words_of("object_id", true).scale == PageScale::ids);
  CHECK(words_of("f0.saturated", true).scale == PageScale::bits);
}

TEST_CASE("what nobody knows is called by its name") {
  for (const char *name : {"<b>", "f.x", "f99999.x", "fx.y", "", "f1."}) {
    const ChannelWords words = words_of(name, true);
    CHECK(words.quantity == (std::string(name) == "f1." ? "" : name));
    CHECK(words.group == "More");
    CHECK(words.scale == PageScale::ids);
  }
}
