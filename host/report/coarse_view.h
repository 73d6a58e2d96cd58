#pragma once
// What a sensor's rays see of a setup's scene at its start, few of them, without a device.

#include "host/input/setup/setup.h"

#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// Of the rays of a coarse frame that hit something: how far from the lens, metres, and where, world frame.
struct CoarseView {
  std::vector<double> ranges_m;
  std::vector<glm::dvec3> points_m;
};

CoarseView coarse_view(const Setup &setup, const Sensor &sensor);

} // namespace pmdsim
