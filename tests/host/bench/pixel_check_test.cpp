// The suite's check of some pixels passes a sound frame, and finds what is wrong in others.

#include "host/bench/real/pixel_check.h"
#include "host/bench/real/scene_files.h"
#include "host/capture/camera.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace pmdsim;

namespace {

struct Checked {
  Setup setup = setup_of_kind(*find_kind("knot"), 1000, 12);
  Measurement frame = [&] {
    Camera camera("", {.sample_triangles = true, .reached = true});
    camera.prepare(setup, setup.start.sensors.front());
    return camera.measure();
  }();
  std::vector<std::uint32_t> pixels = [&] {
    std::vector<std::uint32_t> all(frame.sample_triangle_id.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }();

  PixelCheck check() const { return check_pixels(setup, frame, pixels); }
};

} // namespace

TEST_CASE("a sound frame has neither a pair nor a distance off") {
  const Checked checked;
  const PixelCheck check = checked.check();
  CHECK(check.compared.same_triangles > 140);
  CHECK(check.compared.pairs >= 240 * check.compared.same_triangles);
  CHECK(check.pairs_beyond_rounding == 0);
  CHECK(check.compared.too_far == 0);
  CHECK(check.compared.distance_max_m < 1e-5);
}

TEST_CASE("each pair that is decided otherwise counts, and so does each distance") {
  Checked checked;
  const PixelCheck before = checked.check();
  // A corner of the wall, which every diode lights.
  checked.frame.sample_visibility[2] ^= 1u << 5 | 1u << 6;
  checked.frame.returns.front().distance_m[11] += 1e-3f;
  const PixelCheck after = checked.check();
  CHECK(after.compared.pairs_apart == before.compared.pairs_apart + 2);
  CHECK(after.pairs_beyond_rounding == 2);
  CHECK(after.compared.too_far == 1);
  CHECK(after.compared.distance_max_m == Approx(1e-3).epsilon(1e-2));
}

TEST_CASE("some of a frame's pixels are checked") {
  Checked checked;
  checked.pixels = {11, 77};
  CHECK(checked.check().compared.comparable == 2);
  const PixelCheck some = check_some_pixels(checked.setup, {});
  CHECK(some.compared.resolution == glm::uvec2(1, 2)); // 1 % of 144, rounded up
}
