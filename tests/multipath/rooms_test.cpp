// Light that bounces in random rooms, against the reference's path tracer.

#include "engine/reference/reference.h"
#include "tests/multipath/frames.h"
#include "tests/support/random_rooms.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct RoomErrors {
  std::size_t pixels = 0;
  std::size_t kept = 0; // within two standard errors of the reference and what was claimed
};

RoomErrors room_errors(const Room &room, std::uint32_t number, const Bounces &bounces, std::uint32_t pixels,
                       std::uint32_t paths) {
  const Measurement frame = bounced_frame(room.scene, room.sensor, {room.light}, bounces);
  reference::Options options{Shadows::automatic};
  options.bounces = bounces;
  options.paths = paths;
  Random random(number);
  for (std::uint32_t i = 0; i < pixels; ++i)
    options.pixels.push_back(static_cast<std::uint32_t>(random.uniform(0.0, 0.999) *
                                                        static_cast<double>(room.sensor.pixel_count())));
  const reference::Frame expected =
      reference::simulate(room.scene, room.sensor, {room.light}, Backscatter::lambert, options);
  RoomErrors errors;
  std::vector<double> off_m, standard_m;
  for (std::size_t i = 0; i < options.pixels.size(); ++i) {
    const double expected_m = expected.returns[0].multipath_m[i];
    const auto found_m = static_cast<double>(frame.returns[0].multipath_m[options.pixels[i]]);
    if (std::isnan(expected_m) || std::isnan(found_m))
      continue;
    const double error_m = std::abs(std::remainder(found_m - expected_m, room.sensor.ambiguity_m()));
    const double standard_error_m = expected.returns[0].multipath_error_m[i];
    const auto claimed_m = static_cast<double>(frame.returns[0].multipath_error_m[options.pixels[i]]);
    ++errors.pixels;
    errors.kept += error_m <= 2.0 * standard_error_m + claimed_m ? 1u : 0u;
    off_m.push_back(error_m);
    standard_m.push_back(standard_error_m);
  }
  std::ranges::sort(off_m);
  std::ranges::sort(standard_m);
  fmt::print("room {:>2}: multipath {:.1f} mm, claimed {:.3f} mm, median off by {:.3f} mm, standard error "
             "{:.3f} mm, {} of {} kept\n",
             number, 1e3 * expected.returns[0].multipath_m[options.pixels.size() / 2],
             1e3 * frame.bounces->claimed_m, 1e3 * off_m[off_m.size() / 2],
             1e3 * standard_m[standard_m.size() / 2], errors.kept, errors.pixels);
  return errors;
}

void check_rooms(std::uint32_t rooms, const Bounces &bounces, std::uint32_t pixels, std::uint32_t paths) {
  RoomErrors all;
  for (std::uint32_t number = 0; number < rooms; ++number) {
    const RoomErrors errors = room_errors(random_room(number), number, bounces, pixels, paths);
    all.pixels += errors.pixels;
    all.kept += errors.kept;
  }
  CHECK(all.pixels > rooms * pixels / 2);
  CHECK(static_cast<double>(all.kept) >= 0.95 * static_cast<double>(all.pixels));
}

} // namespace

TEST_CASE("light bounces in random rooms as paths do") { check_rooms(2, {all_bounces, 2e-3}, 40, 1 << 13); }

TEST_CASE("light bounces in twenty random rooms as many paths do", "[long]") {
  check_rooms(20, {all_bounces, 1e-3}, 60, 1 << 18);
}

// A third of the error takes twice the elements.
TEST_CASE("with twice the elements frames move by less than was claimed", "[long]") {
  for (const std::uint32_t number : {0u, 1u, 4u, 9u, 12u, 18u}) {
    const Room room = random_room(number);
    const auto frame = [&](double error_m) {
      return bounced_frame(room.scene, room.sensor, {room.light}, {all_bounces, error_m});
    };
    const Measurement asked = frame(1e-3), finer = frame(0.37e-3);
    std::size_t pixels = 0, kept = 0;
    for (std::size_t i = 0; i < asked.returns[0].multipath_m.size(); ++i) {
      const float moved = std::abs(asked.returns[0].multipath_m[i] - finer.returns[0].multipath_m[i]);
      pixels += std::isnan(moved) ? 0u : 1u;
      kept += moved <= asked.returns[0].multipath_error_m[i] ? 1u : 0u;
    }
    fmt::print("room {:>2}: {} elements, then {}: {} of {} pixels moved by no more than was claimed\n",
               number, asked.bounces->elements, finer.bounces->elements, kept, pixels);
    CHECK(finer.bounces->elements > asked.bounces->elements);
    CHECK(static_cast<double>(kept) >= 0.95 * static_cast<double>(pixels));
  }
}

TEST_CASE("light bounces a few times in random rooms as paths do", "[long]") {
  check_rooms(4, {1, 1e-3}, 60, 1 << 17);
  check_rooms(4, {3, 1e-3}, 60, 1 << 17);
}

TEST_CASE("light of any waveform bounces as paths do") {
  Room room = random_room(2);
  room.sensor.modulation_hz = {20e6, 45e6};
  SECTION("square") { room.sensor.waveform.kind = Waveform::Kind::square; }
  SECTION("harmonics, of which the third is taken for the first's mirror image") {
    room.sensor.waveform = {Waveform::Kind::harmonics, {1.0, 0.3, 0.2}};
  }
  const RoomErrors errors = room_errors(room, 2, {all_bounces, 5e-3}, 40, 1 << 12);
  CHECK(static_cast<double>(errors.kept) >= 0.9 * static_cast<double>(errors.pixels));
}
