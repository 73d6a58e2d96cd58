#pragma once
// Frames of the simulator with light that bounces.

#include "engine/simulator.h"
#include "tests/support/simulator.h"

#include <vector>

namespace pmdsim::test {

inline Measurement bounced_frame(Simulator &simulator, const Scene &scene, const Sensor &sensor,
                                 const std::vector<Illuminator> &illuminators, const Bounces &bounces,
                                 Shadows shadows = Shadows::automatic) {
  simulator.prepare(scene, sensor, illuminators, Backscatter::lambert, shadows, {}, bounces);
  return simulator.measure();
}

inline Measurement bounced_frame(const Scene &scene, const Sensor &sensor,
                                 const std::vector<Illuminator> &illuminators, const Bounces &bounces,
                                 const SimulatorOptions &options = {}) {
  Simulator simulator = make_simulator(options);
  return bounced_frame(simulator, scene, sensor, illuminators, bounces);
}

} // namespace pmdsim::test
