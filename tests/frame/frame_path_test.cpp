// Forms of a frame's path: one that is forbidden is not taken, and none changes what a frame measures.

#include "tests/comparison/frame_bytes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

struct Form {
  std::string name;
  bool PathForms::*allowed;
  std::string frame; // that takes it
  std::string of;    // the name in the path's description
};

const std::vector<Form> forms{
    {"moments", &PathForms::moments, "records_without_gaps", "sum"},
    {"depth records", &PathForms::depth_records, "records_without_gaps", "record"},
    {"polynomial moments", &PathForms::polynomial_moments, "polynomial_ring", "sum"},
    {"equal weights", &PathForms::equal_weights, "polynomial_ring", "sum"},
    {"coplanar sources", &PathForms::coplanar, "polynomial_ring", "sum"},
    {"uniform pixels", &PathForms::uniform_pixels, "automatic", "pixels"},
    {"uniform pixels of one sample", &PathForms::uniform_single_samples, "automatic_one_sample", "pixels"},
    {"refined uniform pixels", &PathForms::refined_uniform_pixels, "automatic", "pixels"},
};

// A repeatability frame, or the same with sources of one kind beside the lens.
RepeatabilityFrame frame_of(const std::string &name) {
  if (name != "polynomial_ring")
    return repeatability_frame(name);
  RepeatabilityFrame frame = repeatability_frame("records_without_gaps");
  frame.illuminator.world_from_illuminator = frame.sensor.world_from_camera;
  frame.illuminator.diodes.resize(24);
  for (std::size_t i = 0; i < frame.illuminator.diodes.size(); ++i) {
    const double angle_rad = 0.2618 * static_cast<double>(i);
    frame.illuminator.diodes[i] = Diode{};
    frame.illuminator.diodes[i].position_m = {0.02 * std::cos(angle_rad), 0.02 * std::sin(angle_rad), 0.0};
  }
  return frame;
}

struct Taken {
  Measurement measured;
  std::string description; // of the form
};

Taken take(const Form &form, bool allowed) {
  const RepeatabilityFrame frame = frame_of(form.frame);
  SimulatorOptions options;
  options.loop = DiodeLoop::looped; // compiles faster
  options.allowed.*form.allowed = allowed;
  Simulator simulator = make_simulator(options);
  simulator.prepare(frame.scene, frame.sensor, {frame.illuminator}, Backscatter::constant, frame.shadows,
                    frame.accuracy);
  const auto path = simulator.path();
  const auto of = std::ranges::find(path, form.of, &std::pair<std::string, std::string>::first);
  REQUIRE(of != path.end());
  return {simulator.measure(), of->second};
}

// In units of the error that is asked for where none is: 10 micrometres.
double largest_difference_m(const Measurement &a, const Measurement &b, double ambiguity_m) {
  double largest_m = 0.0;
  for (std::size_t i = 0; i < a.returns[0].distance_m.size(); ++i) {
    const float x = a.returns[0].distance_m[i], y = b.returns[0].distance_m[i];
    REQUIRE(std::isnan(x) == std::isnan(y));
    if (!std::isnan(x))
      largest_m = std::max(largest_m, std::abs(std::remainder(static_cast<double>(x - y), ambiguity_m)));
  }
  return largest_m;
}

} // namespace

TEST_CASE("a form of the path that is forbidden is not taken and changes nothing else") {
  for (const Form &form : forms) {
    INFO(form.name);
    const Taken with = take(form, true), without = take(form, false);
    CHECK(with.description != without.description);
    CHECK(largest_difference_m(with.measured, without.measured,
                               repeatability_frame("records_without_gaps").sensor.ambiguity_m()) <=
          2 * default_max_error_m);
  }
}
