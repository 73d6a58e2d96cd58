// Lenses whose distortion folds over inside the image: pixels beyond the fold see nothing, as the reference
// says, and all others what they see.

#include "engine/lens/lens.h"
#include "tests/comparison/comparison.h"
#include "tests/comparison/engines.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct FoldingLens {
  const char *name;
  Distortion distortion;
  double focal_length_m;
  bool is_round; // the fold
};

Sensor folding(const FoldingLens &lens, std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = {96, 72};
  sensor.pixel_pitch_m = glm::dvec2(20e-6);
  sensor.focal_length_m = lens.focal_length_m;
  sensor.distortion = lens.distortion;
  sensor.samples = samples;
  sensor.dark_beyond_fold = true;
  return sensor;
}

Scene two_walls() {
  SceneBuilder builder;
  builder.add_wall({.z_m = 2.0});
  builder.add_wall({.z_m = 1.2, .surface = {0.8, false}, .lower_m = {-0.4, -10.0}, .upper_m = {0.1, 10.0}});
  return builder.scene();
}

// Samples farther than half a sample from the fold where the two see different things.
struct Apart {
  std::size_t dark = 0;  // nothing is measured, and the reference sees something
  std::size_t other = 0; // anything else
};

Apart apart(const Measurement &measured, const reference::Frame &expected, const Sensor &sensor) {
  const Lens lens(sensor);
  Apart count;
  const std::uint32_t columns = sensor.resolution.x * sensor.samples;
  for (std::size_t i = 0; i < measured.sample_triangle_id.size(); ++i) {
    if (measured.sample_triangle_id[i] == expected.sample_triangle_id[i])
      continue;
    const glm::dvec2 place =
        (glm::dvec2(i % columns, i / columns) + 0.5) / static_cast<double>(sensor.samples);
    std::size_t rays = 0;
    for (const double dx : {-0.5, 0.5})
      for (const double dy : {-0.5, 0.5})
        if (lens.ray(lens.on_chip_m(place + glm::dvec2(dx, dy) / static_cast<double>(sensor.samples))))
          ++rays;
    if (rays == 0 || rays == 4)
      ++(measured.sample_triangle_id[i] == no_id ? count.dark : count.other);
  }
  return count;
}

} // namespace

TEST_CASE("beyond the fold of a distortion nothing is seen") {
  const FoldingLens lens =
      GENERATE(FoldingLens{"Brown, k1 = -0.35", BrownConrady{-0.35, 0, 0, 0, 0}, 1.15e-3, true},
               FoldingLens{"Brown, tangential too", BrownConrady{-0.3, 0, 0.01, -0.02, 0}, 1.15e-3, false},
               FoldingLens{"fisheye", Fisheye{-0.12, 0, 0, 0}, 0.8e-3, true});
  for (const std::uint32_t samples : {1u, 3u}) {
    const Sensor sensor = folding(lens, samples);
    Sensor refused = sensor;
    refused.dark_beyond_fold = false;
    REQUIRE(lens_fault(refused));
    REQUIRE_FALSE(lens_fault(sensor));
    const Scene scene = two_walls();
    const Illuminator light = diode_beside_lens(sensor, diode_at({0.1, 0.0, 0.0}));
    SimulatorOptions options;
    options.keep_sample_ids = true;
    const Measurement measured = measure(Engine::vulkan, scene, sensor, light, Backscatter::lambert, options);
    const reference::Frame expected = reference::simulate(scene, sensor, {light}, Backscatter::lambert);
    std::size_t dark = 0;
    for (const float coverage : measured.coverage)
      dark += coverage == 0.0f ? std::size_t{1} : 0;
    fmt::print("{:<28} {} x {} samples: {} of {} pixels see nothing\n", lens.name, samples, samples, dark,
               measured.coverage.size());
    CHECK(dark > 20);
    CHECK(dark < measured.coverage.size() / 2);
    // By tangential terms the fold is no circle, and where it bulges the image ends at the circle.
    const auto [darker, other] = apart(measured, expected, sensor);
    CHECK(darker <= (lens.is_round ? 0 : measured.sample_triangle_id.size() / 1000));
    CHECK(other == 0);
    const Comparison comparison = compare(measured, expected, scene, sensor);
    CHECK(comparison.distance_max_m < 1.1e-6);
    CHECK(comparison.disagreements == 0);
  }
}
