#pragma once
// The frame that the reference sees by a light in the lens.

#include "engine/reference/reference.h"
#include "tests/support/scenes.h"

namespace pmdsim::test {

inline reference::Frame monostatic_frame(const Scene &scene, const Sensor &sensor) {
  return reference::simulate(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                             Backscatter::constant);
}

} // namespace pmdsim::test
