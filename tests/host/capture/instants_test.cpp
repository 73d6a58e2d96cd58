// Instants that are computed ahead are those that are asked for, in whatever order.

#include "engine/model/error.h"
#include "host/capture/exposure.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

Setup moving_setup() { return load_setup(test::scene("motion.json")); }

// The places of all illuminators.
std::vector<double> places(const Instant &instant) {
  std::vector<double> numbers;
  for (const Illuminator &illuminator : instant.illuminators)
    for (int i = 0; i < 3; ++i)
      numbers.push_back(illuminator.world_from_illuminator.translation_m[i]);
  return numbers;
}

} // namespace

TEST_CASE("an instant is the same, expected or not") {
  const Setup setup = moving_setup();
  REQUIRE(places(setup.at(0.0)) != places(setup.at(0.5)));
  Instants instants(setup);
  for (const double time_s : {0.0, 0.5, 0.25}) {
    instants.expect(time_s);
    CHECK(places(instants.at(time_s)) == places(setup.at(time_s)));
  }
}

TEST_CASE("another instant than the expected one is that which was asked for") {
  const Setup setup = moving_setup();
  Instants instants(setup);
  instants.expect(0.5);
  CHECK(places(instants.at(0.25)) == places(setup.at(0.25)));
  CHECK(places(instants.at(0.5)) == places(setup.at(0.5)));
  instants.expect(0.0);
  instants.expect(0.75);
  CHECK(places(instants.at(0.75)) == places(setup.at(0.75)));
}

TEST_CASE("what is expected does not disturb what is there") {
  const Setup setup = moving_setup();
  Instants instants(setup);
  const Instant &now = instants.at(0.0);
  const Instant *const address = &now;
  instants.expect(0.5);
  CHECK(instants.holds(0.0));
  CHECK_FALSE(instants.holds(0.5));
  CHECK(&instants.at(0.0) == address);
  CHECK(places(now) == places(setup.at(0.0)));
  CHECK(places(instants.at(0.5)) == places(setup.at(0.5)));
}

TEST_CASE("where nothing moves one instant serves all times") {
  const test::Workspace work;
  work.write("wall.gltf", test::wall_gltf());
  const Setup setup = load_setup(work.write("setup.json", test::small_setup()));
  Instants instants(setup);
  instants.expect(1.0);
  CHECK(&instants.at(1.0) == &setup.start);
  CHECK(instants.holds(7.0));
}
