// What is left out where a page would be too large, and that the page says so.

#include "host/output/page/page_plan.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

constexpr double mib = 1024.0 * 1024.0;

std::vector<SensorSize> one_sensor(std::size_t frames, double other_mib, double raw_mib = 0.0) {
  return {{frames, 640, 640, raw_mib * mib, other_mib * mib}};
}

} // namespace

TEST_CASE("what fits is there, all of it") {
  CHECK(plan_for(one_sensor(2, 3.0, 1.9), 10.0 * mib) == PagePlan{1, 1, true});
}

TEST_CASE("single images go first, then frames down to 16, then pixels") {
  CHECK(plan_for(one_sensor(2, 3.0, 2.1), 10.0 * mib) == PagePlan{1, 1, false});
  CHECK(plan_for(one_sensor(40, 0.4), 10.0 * mib) == PagePlan{2, 1, false});  // 20 frames, 8 MiB
  CHECK(plan_for(one_sensor(40, 1.0), 10.0 * mib) == PagePlan{1, 2, false});  // 40 quarters
  CHECK(plan_for(one_sensor(40, 1.2), 10.0 * mib) == PagePlan{2, 2, false});  // 20 quarters, 6 MiB
  CHECK(plan_for(one_sensor(1, 30.0), 10.0 * mib) == PagePlan{1, 2, false});  // 7.5 MiB
  CHECK(plan_for(one_sensor(1, 400.0), 10.0 * mib) == PagePlan{1, 8, false}); // 6.25 MiB
}

TEST_CASE("the sensors share the room") {
  std::vector<SensorSize> two = one_sensor(1, 6.0);
  two.push_back({1, 320, 240, 0.0, 5.0 * mib});
  CHECK(plan_for(two, 10.0 * mib) == PagePlan{1, 2, false});
  CHECK(plan_for(two, 11.0 * mib) == PagePlan{});
}

TEST_CASE("where nothing fits it is as small as it gets") {
  const PagePlan plan = plan_for(one_sensor(40, 400.0), 1.0);
  CHECK(plan == PagePlan{2, 32, false});
  CHECK(plan_for(one_sensor(1, 400.0), 0.0) == PagePlan{1, 32, false});
}

TEST_CASE("what is left out is said in plain words") {
  CHECK(left_out_text({}, 3, {"tap0"}).empty());
  CHECK(left_out_text({3, 2, false}, 100, {"tap0", "tap1"}) ==
        std::vector<std::string>{
            "Of 100 frames only every 3rd is here.",
            "Only every 2nd pixel of every 2nd row is here, with the values that the files "
            "have.",
            "The 2 channels from tap0 to tap1 are not here."});
  CHECK(left_out_text({11, 1, false}, 100, {}) ==
        std::vector<std::string>{"Of 100 frames only every 11th is here."});
  CHECK(left_out_text({1, 1, false}, 1, {"tap0"}) ==
        std::vector<std::string>{"The channel tap0 is not here."});
}
