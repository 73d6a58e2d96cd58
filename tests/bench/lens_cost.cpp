// The cost of a lens with distortion, by what is seen through it: ordinary scenes, and thin things. Frames
// are warm and have 640 x 640 samples, whose triangles are first compared with the reference's. Not a test:
// times are reported, never asserted. With a part of scenes' names as argument only those are measured.

#include "engine/reference/reference.h"
#include "engine/simulator.h"
#include "host/input/setup/setup.h"
#include "tests/bench/hills.h"
#include "tests/bench/times.h"
#include "tests/support/scenes.h"
#include "tests/support/thin_things.h"

#include <array>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

using namespace pmdsim;

namespace {

constexpr int rounds = 9;

struct Lens {
  std::string name;
  Distortion distortion;
  double focal_length_m;
};

const std::array lenses{Lens{"Brown-Conrady", BrownConrady{-0.25, 0.08, 1e-3, -2e-3, -0.01}, 0.02494},
                        Lens{"fisheye", Fisheye{-0.03, 0.01, -0.004, 0.0005}, 0.0095}};

Sensor sensor_of(const Lens &lens, const Pose &world_from_camera) {
  Sensor sensor;
  sensor.focal_length_m = lens.focal_length_m;
  sensor.distortion = lens.distortion;
  sensor.world_from_camera = world_from_camera;
  return sensor;
}

struct View {
  std::string name;
  Pose world_from_camera = node_from_camera();
  std::function<Scene(const Sensor &)> scene;
};

std::vector<View> views() {
  const Setup room = load_setup(PMDSIM_SCENES "/room.json");
  test::Random random(1);
  return {
      {"wall", node_from_camera(), [](const Sensor &) { return test::wall_at(2.0); }},
      {"room", room.start.sensors[0].world_from_camera,
       [scene = room.start.scene](const Sensor &) { return scene; }},
      {"hills", node_from_camera(), [](const Sensor &) { return bench::hills(); }},
      {"rods", node_from_camera(),
       [random](const Sensor &sensor) mutable { return test::rods_in_view(random, 1000, 0.4, sensor); }},
      {"points", node_from_camera(),
       [random](const Sensor &sensor) mutable { return test::points_in_view(random, 20000, 0.8, sensor); }},
      {"grass", node_from_camera(),
       [random](const Sensor &sensor) mutable { return test::grass(random, 6000, sensor); }}};
}

double pass_ms(const Measurement &measurement, const std::string &name) {
  for (const PassTime &pass : measurement.passes)
    if (pass.name == name)
      return pass.ms;
  return 0.0;
}

// Samples that see something else than the reference's.
std::size_t differing(Simulator &simulator, const Scene &scene, const Sensor &sensor,
                      const std::vector<Illuminator> &light) {
  const reference::Frame truth = reference::simulate(scene, sensor, light, Backscatter::lambert);
  simulator.prepare(scene, sensor, light, Backscatter::lambert);
  const std::vector<std::uint32_t> seen = simulator.measure().sample_triangle_id;
  std::size_t count = 0;
  for (std::size_t i = 0; i < seen.size(); ++i)
    count += seen[i] != truth.sample_triangle_id[i];
  return count;
}

void time(const View &view, const Lens &lens) {
  const Sensor sensor = sensor_of(lens, view.world_from_camera);
  const Scene scene = view.scene(sensor);
  const std::vector<Illuminator> light{monostatic_illuminator(sensor.world_from_camera)};
  Simulator simulator({.device = {}, .keep_sample_ids = true});
  const std::size_t wrong = differing(simulator, scene, sensor, light);
  std::vector<double> prepare_ms, visibility_ms, points_ms, frame_ms;
  for (int round = 0; round < rounds; ++round) {
    const auto start = std::chrono::steady_clock::now();
    simulator.prepare(scene, sensor, light, Backscatter::lambert);
    const std::chrono::duration<double, std::milli> prepared = std::chrono::steady_clock::now() - start;
    const Measurement measured = simulator.measure();
    prepare_ms.push_back(prepared.count());
    visibility_ms.push_back(pass_ms(measured, "visibility"));
    points_ms.push_back(pass_ms(measured, "points"));
    frame_ms.push_back(measured.frame_ms);
  }
  fmt::print("{:<24}{:>10.2f}{:>12.2f}{:>10.2f}{:>10.2f}{:>12}\n", view.name + ", " + lens.name,
             bench::spread(prepare_ms).median_ms, bench::spread(visibility_ms).median_ms,
             bench::spread(points_ms).median_ms, bench::spread(frame_ms).median_ms, wrong);
  std::fflush(stdout); // the next may take minutes
}

} // namespace

int main(int argc, char **argv) {
  const std::string wanted = argc > 1 ? argv[1] : "";
  fmt::print("{:<24}{:>10}{:>12}{:>10}{:>10}{:>12}\n", "ms, medians", "prepare", "visibility", "points",
             "frame", "differing");
  for (const View &view : views())
    if (view.name.find(wanted) != std::string::npos)
      for (const Lens &lens : lenses)
        time(view, lens);
}
