// Normals and rays of frames: of scenes that move, whose taps may be exposures of their own.

#include "host/capture/exposure.h"
#include "host/input/setup/parts.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// A wall about the optical axis at 2 m that is tilted by as many radians as seconds have gone by, so that its
// upper half goes away; the world's +y is up.
struct TiltingWall {
  Workspace work;
  Setup setup;

  explicit TiltingWall(double tap_interval_s) {
    work.write("wall.gltf", wall_gltf());
    setup = load_setup(work.write("setup.json", small_setup()));
    setup.start.sensors[0].tap_interval_s = tap_interval_s;
    setup.frames.rate_hz = 10.0;
    setup.frames.count = 4;
    const GltfFile gltf = load_gltf(work / "wall.gltf", {setup.file});
    const auto tilted = [gltf](double time_s) {
      GltfScene moved = gltf.at(time_s);
      for (glm::dvec3 &position_m : moved.scene.positions_m)
        position_m.z -= std::tan(time_s) * position_m.y;
      return moved;
    };
    setup.motion = std::make_shared<const Motion>(tilted, Trajectories{}, setup.as_used, Place{setup.file});
  }
};

// In the camera's frame, y down: it faces up.
void check_frame(const Measurement &frame, double tilt_rad) {
  REQUIRE(frame.normal_y.size() == 64);
  for (std::size_t i = 0; i < 64; ++i) {
    if (std::isnan(frame.range_m[i])) {
      CHECK(std::isnan(frame.normal_z[i]));
      continue;
    }
    CHECK(frame.normal_x[i] == Approx(0.0).margin(1e-6));
    CHECK(frame.normal_y[i] == Approx(-std::sin(tilt_rad)).margin(1e-6));
    CHECK(frame.normal_z[i] == Approx(-std::cos(tilt_rad)).margin(1e-6));
    CHECK(frame.range_m[i] * frame.ray_z[i] == Approx(frame.z_m[i]).epsilon(1e-6));
    const float height_m = -frame.range_m[i] * frame.ray_y[i];
    CHECK(frame.z_m[i] == Approx(2.0 + std::tan(tilt_rad) * height_m).epsilon(1e-5));
  }
}

} // namespace

TEST_CASE("normals are those of the scene when the frame begins, on any device, tap by tap or at once") {
  const std::string device = GENERATE(as<std::string>{}, "", "reference");
  const double tap_interval_s = GENERATE(0.0, 5e-3);
  const std::string light = GENERATE("coverage", "distance_m");
  INFO(device << ", " << tap_interval_s << " s, " << light);
  const TiltingWall wall(tap_interval_s);
  const WantedChannels wanted({"normals", "rays", "range_m", "z_m", light});
  Exposures exposures(wall.setup, device, false, {}, 0, wanted);
  for (const std::uint32_t number : {3u, 0u, 1u}) {
    const TakenFrame taken = exposures.take(
        0, number, Light::beside_lens, [](double) {}, wall.setup.frames.time_s(2));
    check_frame(taken.measurement, wall.setup.frames.time_s(number));
    CHECK(taken.measurement.triangle_id.empty());
  }
}

TEST_CASE("normals and rays are there on demand alone, and beside all others") {
  const TiltingWall wall(0.0);
  const auto taken = [&](const WantedChannels &wanted, bool keep_unrounded) {
    Exposures exposures(wall.setup, "", false, {}, 0, wanted, keep_unrounded);
    return exposures.take(0, 1, Light::beside_lens, [](double) {}).measurement;
  };
  const Measurement usual = taken({}, false), all = taken(WantedChannels({"all", "normals"}), true);
  CHECK(usual.normal_x.empty());
  CHECK(usual.ray_x.empty());
  CHECK(all.ray_x.empty());
  CHECK(all.normal_x.size() == 64);
  CHECK(all.unrounded_normal_x.size() == 64);
  CHECK(all.returns[0].distance_m.size() == 64);
}

TEST_CASE("all may be wanted, and more") {
  const WantedChannels all, more({"all", "rays"}), some({"normals"});
  CHECK(!all.has(row_of(&Measurement::ray_x)));
  CHECK(!all.has(row_of(&Measurement::normal_y)));
  CHECK(more.are_all());
  CHECK(more.has(row_of(&Measurement::ray_x)));
  CHECK(more.has(row_of(&Return::amplitude)));
  CHECK(!more.has(row_of(&Measurement::normal_y)));
  CHECK(more.names() == std::vector<std::string>{"all", "rays"});
  CHECK(!some.are_all());
  CHECK(some.has(row_of(&Measurement::normal_y)));
  CHECK(!some.has(row_of(&Return::amplitude)));
  CHECK_THROWS_WITH(WantedChannels({"normal"}), Catch::Contains("normals"));
}
