// What is thinner than the fragments of a distorted view is seen by the samples whose rays meet it, wherever
// it stands alone.

#include "tests/comparison/comparison.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/support/thin_things.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct NamedLens {
  std::string name;
  Distortion distortion;
  double focal_length_m;
};

const std::array lenses{NamedLens{"pinhole", {}, 0.02},
                        NamedLens{"barrel", BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01}, 0.02},
                        NamedLens{"pincushion", BrownConrady{0.2, 0, 0, 0, 0}, 0.025},
                        NamedLens{"fisheye", Fisheye{-0.03, 0.01, -0.004, 0.0005}, 0.009},
                        NamedLens{"wide fisheye", Fisheye{}, 0.006}};

Sensor sensor_of(const NamedLens &lens, std::uint32_t samples) {
  Sensor sensor;
  sensor.resolution = glm::uvec2(160, 120) / samples;
  sensor.pixel_pitch_m = glm::dvec2(24e-3 / sensor.resolution.x);
  sensor.focal_length_m = lens.focal_length_m;
  sensor.distortion = lens.distortion;
  sensor.samples = samples;
  return sensor;
}

Measurement measure(const Scene &scene, const Sensor &sensor, std::uint32_t max_strip_samples) {
  Simulator simulator =
      make_simulator({.device = {}, .max_strip_samples = max_strip_samples, .keep_sample_ids = true});
  simulator.prepare(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  return simulator.measure();
}

struct Count {
  std::size_t expected = 0, seen = 0, wrong = 0;
};

Count count(const Scene &scene, const Sensor &sensor) {
  const reference::Frame truth = reference::simulate(
      scene, sensor, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant);
  const Measurement measured = measure(scene, sensor, 0);
  Count count;
  for (std::size_t i = 0; i < truth.sample_triangle_id.size(); ++i) {
    const bool should = truth.sample_triangle_id[i] != no_id,
               same = truth.sample_triangle_id[i] == measured.sample_triangle_id[i];
    count.expected += should;
    count.seen += should && same;
    count.wrong += !same;
  }
  return count;
}

} // namespace

TEST_CASE("thin things") {
  for (const NamedLens &lens : lenses)
    for (const std::uint32_t samples : {1u, 2u, 4u}) {
      const Sensor sensor = sensor_of(lens, samples);
      Random random(samples);
      const auto print = [&](const char *name, const Count &c) {
        fmt::print("{:<14} {} {:<8} expected {:>7} seen {:.3f} % wrong {}\n", lens.name, samples, name,
                   c.expected, 100.0 * double(c.seen) / double(c.expected), c.wrong);
      };
      print("rods", count(rods_in_view(random, 60, 0.4, sensor), sensor));
      print("points", count(points_in_view(random, 2000, 0.6, sensor), sensor));
      print("grass", count(grass(random, 1500, sensor), sensor));
    }
}
