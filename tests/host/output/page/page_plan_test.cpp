// What is left out where a page would be too large, and that the page says so.

#include "host/output/page/page_plan.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

constexpr double mib = 1024.0 * 1024.0;

constexpr auto raw = ChannelRank::raw, secondary = ChannelRank::secondary, main_ones = ChannelRank::main;

std::vector<SensorSize> one_sensor(std::size_t frames, double main_mib, double secondary_mib = 0.0,
                                   double raw_mib = 0.0) {
  return {{frames, 640, 640, {main_mib * mib, secondary_mib * mib, raw_mib * mib}}};
}

} // namespace

TEST_CASE("what fits is there, all of it") {
  CHECK(plan_for(one_sensor(2, 3.0, 1.0, 0.9), 10.0 * mib) == PagePlan{1, 1, raw});
}

TEST_CASE("single images go first, then secondary channels, then frames down to 16, then pixels") {
  CHECK(plan_for(one_sensor(2, 3.0, 1.0, 1.1), 10.0 * mib) == PagePlan{1, 1, secondary});
  CHECK(plan_for(one_sensor(2, 3.0, 2.1, 1.0), 10.0 * mib) == PagePlan{1, 1, main_ones});
  CHECK(plan_for(one_sensor(40, 0.4), 10.0 * mib) == PagePlan{2, 1, main_ones});  // 20 frames, 8 MiB
  CHECK(plan_for(one_sensor(40, 0.65), 10.0 * mib) == PagePlan{1, 2, main_ones}); // 14 frames would fit
  CHECK(plan_for(one_sensor(40, 1.0), 10.0 * mib) == PagePlan{1, 2, main_ones});  // 40 quarters
  CHECK(plan_for(one_sensor(40, 1.2), 10.0 * mib) == PagePlan{2, 2, main_ones});  // 20 quarters, 6 MiB
  CHECK(plan_for(one_sensor(1, 30.0), 10.0 * mib) == PagePlan{1, 2, main_ones});  // 7.5 MiB
  CHECK(plan_for(one_sensor(1, 400.0), 10.0 * mib) == PagePlan{1, 8, main_ones}); // 6.25 MiB
}

TEST_CASE("the sensors share the room") {
  std::vector<SensorSize> two = one_sensor(1, 6.0);
  two.push_back({1, 320, 240, {5.0 * mib, 0.0, 0.0}});
  CHECK(plan_for(two, 10.0 * mib) == PagePlan{1, 2, main_ones});
  CHECK(plan_for(two, 11.0 * mib) == PagePlan{});
}

TEST_CASE("where nothing fits it is as small as it gets") {
  const PagePlan plan = plan_for(one_sensor(40, 400.0), 1.0);
  CHECK(plan == PagePlan{2, 32, main_ones});
  CHECK(plan_for(one_sensor(1, 400.0), 0.0) == PagePlan{1, 32, main_ones});
}

TEST_CASE("what is left out is said in plain words") {
  const ChannelsByRank channels{{{"distance_m"}, {"phase_rad", "triangle_id"}, {"tap0"}}};
  CHECK(left_out_text({}, 3, channels).empty());
  CHECK(left_out_text({3, 2, main_ones}, 100, channels) ==
        std::vector<std::string>{
            "Of 100 frames only every 3rd is here.",
            "Only every 2nd pixel of every 2nd row is here, with the values that the files "
            "have.",
            "The channels phase_rad, triangle_id are not here.", "The channel tap0 is not here."});
  const ChannelsByRank many{{{}, {}, {"tap0", "tap1", "tap2", "tap3", "tap4", "tap5", "tap6"}}};
  CHECK(left_out_text({11, 1, secondary}, 100, many) ==
        std::vector<std::string>{"Of 100 frames only every 11th is here.",
                                 "The 7 channels from tap0 to tap6 are not here."});
}
