// A frame with bounces is that of its own scene, light and sensor, however it comes about.

#include "engine/model/channels.h"
#include "host/input/setup/setup.h"
#include "tests/multipath/frames.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>
#include <cstring>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr Bounces coarse{all_bounces, 10e-3};

// Whether two frames have the same bits in every channel.
bool same(Measurement &a, Measurement &b) {
  std::vector<std::vector<char>> bits[2];
  for (std::size_t i = 0; i < 2; ++i)
    for_each_channel(i == 0 ? a : b, [&](const ChannelIndex &, const auto &values) {
      const auto *first = reinterpret_cast<const char *>(values.data());
      bits[i].emplace_back(first, first + values.size() * sizeof(values[0]));
    });
  return bits[0] == bits[1];
}

Room small_room(std::uint32_t samples = 1) {
  Room room = random_room(2);
  room.sensor.samples = samples;
  return room;
}

} // namespace

TEST_CASE("frames with bounces have the same bits again, and whatever the strips") {
  const Room room = small_room(2);
  Simulator simulator = make_simulator();
  Measurement first = bounced_frame(simulator, room.scene, room.sensor, {room.light}, coarse);
  Measurement second = simulator.measure();
  CHECK(same(first, second));
  SimulatorOptions strips;
  strips.max_strip_samples = 4 * room.sensor.resolution.x * 4;
  Measurement cut = bounced_frame(room.scene, room.sensor, {room.light}, coarse, strips);
  CHECK(same(first, cut));
}

TEST_CASE("bounces are those of the scene, light and sensor that were prepared last") {
  const Room room = small_room();
  Simulator used = make_simulator();
  bounced_frame(used, room.scene, room.sensor, {room.light}, coarse);
  Room other = room;
  Bounces bounces = coarse;
  SECTION("another sensor") { other.sensor.world_from_camera.translation_m.x += 0.05; }
  SECTION("another frequency") { other.sensor.modulation_hz = {33e6}; }
  SECTION("another light") { other.light.diodes.front().intensity_w_sr = 30.0; }
  SECTION("another reflectivity") { other.scene.surfaces.front().reflectivity *= 0.5; }
  SECTION("another place of a corner") { other.scene.positions_m.front().y -= 0.05; }
  SECTION("another number of bounces") { bounces.count = 2; }
  Measurement after = bounced_frame(used, other.scene, other.sensor, {other.light}, bounces);
  Measurement fresh = bounced_frame(other.scene, other.sensor, {other.light}, bounces);
  CHECK(same(after, fresh));
}

TEST_CASE("a frame does not depend on one before it that has taken finer elements", "[long]") {
  const Setup setup = load_setup(PMDSIM_SCENES "/corner.json");
  const Bounces fine{all_bounces, 0.4e-3};
  Sensor wide = setup.start.sensors.front();
  wide.resolution = {40, 30};
  wide.pixel_pitch_m *= 4.0;
  Sensor close = wide;
  close.focal_length_m = 0.05;
  const auto frame = [&](Simulator &simulator, const Sensor &sensor) {
    return bounced_frame(simulator, setup.start.scene, sensor, setup.start.illuminators, fine);
  };
  Simulator simulator = make_simulator();
  Measurement first = frame(simulator, wide), second = frame(simulator, close);
  CHECK(first.bounces->elements != second.bounces->elements); // else this proves nothing
  Measurement again = frame(simulator, wide);
  CHECK(same(first, again));
  CHECK(first.bounces->lines == again.bounces->lines);
  Simulator fresh = make_simulator();
  Measurement alone = frame(fresh, close);
  CHECK(same(second, alone));
}

TEST_CASE("where no light comes directly all of it has bounced") {
  Room room = random_room(1);
  // All light goes to the wall behind the lens.
  for (Diode &diode : room.light.diodes) {
    diode.axis = {0.0, 0.0, -1.0};
    diode.pattern = cosine(0.0);
  }
  const Measurement frame = bounced_frame(room.scene, room.sensor, {room.light}, {all_bounces, 50e-3});
  const Return &found = frame.returns[0];
  std::size_t dark = 0;
  for (std::size_t i = 0; i < found.amplitude.size(); ++i)
    if (found.direct_amplitude[i] == 0.0f && found.amplitude[i] > 0.0f) {
      ++dark;
      CHECK(std::isnan(found.multipath_m[i]));
      CHECK(std::isnan(found.direct_distance_m[i]));
      CHECK(found.indirect_share[i] == 1.0f);
      CHECK(found.distance_m[i] > 0.0f);
    }
  CHECK(dark > found.amplitude.size() / 2);
}
