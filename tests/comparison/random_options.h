#pragma once
// Any form of the simulator, its samples' tags kept.

#include "engine/model/simulator_options.h"
#include "tests/support/random_scenes.h"

namespace pmdsim::test {

inline SimulatorOptions random_options(Random &random) {
  SimulatorOptions options;
  options.keep_sample_ids = true;
  options.keep_taps = random.flip();
  options.precision = random.flip() ? SamplePrecision::automatic : SamplePrecision::double_float;
  options.loop = random.flip() ? DiodeLoop::straight_line : DiodeLoop::looped;
  options.allowed.polynomial_moments = random.flip();
  options.allowed.point_polynomials = random.flip();
  options.allowed.direct_pixels = random.flip();
  options.allowed.host_pixels = random.flip();
  return options;
}

} // namespace pmdsim::test
