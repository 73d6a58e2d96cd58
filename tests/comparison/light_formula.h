#pragma once
// Light on a wall across the view by its formula, the paper's eq. 5 to 7, in double: a judge for what the
// reference is not asked here. The wall's points follow from the pixels alone.

#include "engine/model/illuminator.h"
#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"
#include "engine/model/simulator_options.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <functional>
#include <string>
#include <vector>

namespace pmdsim::test {

// The angles of a direction in a diode's own frame; phi is from 0 to 2 pi.
struct Angles {
  double theta_rad, phi_rad;
};

Angles angles_of(const glm::dvec3 &direction, const Diode &diode);

using Gain = std::function<double(const Angles &)>;

// An illuminator in the camera's frame, its diodes alike, and their J.
struct Light {
  Illuminator illuminator;
  Gain gain = [](const Angles &) { return 1.0; };
};

Illuminator light_at(const std::vector<glm::dvec3> &places_m, double phase_rad, const Pattern &pattern = {});
std::vector<glm::dvec3> ring(int count, double radius_m);

// 60 x 45 degrees.
Sensor wide_sensor();

struct WallCase {
  std::string name;
  Sensor sensor = wide_sensor(); // looks along z at a wall with no distortion, one sample a pixel
  double wall_m = 2.0;
  std::vector<Light> lights{};
  Backscatter backscatter = Backscatter::lambert;
  // Where J jumps the two may differ.
  std::function<bool(const glm::dvec3 &)> left_out = [](const glm::dvec3 &) { return false; };
};

// Both shapes of the loop, both precisions.
std::vector<SimulatorOptions> all_variants();

Measurement measure(const WallCase &of, const SimulatorOptions &options);

struct Errors {
  double distance_m = 0.0, amplitude = 0.0; // the latter relative
  std::size_t lit = 0;
};

// The largest errors over all the pixels; checks that those are lit that the formula says.
Errors errors_of(const WallCase &of, const SimulatorOptions &options);

// Prints a line for each variant and checks it to 2 micrometres and the amplitude's tolerance.
void check_wall(const WallCase &of, double amplitude_tolerance = 1e-5);

} // namespace pmdsim::test
