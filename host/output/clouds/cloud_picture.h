#pragma once
// A point cloud seen from the side.

#include "host/output/clouds/cloud.h"
#include "host/output/pictures/canvas.h"

#include <string>

namespace pmdsim {

// From the left of the camera and above it, in perspective, with the nearest point in front, the camera where
// it is not far off, a scale, and what the colours mean. Reads the cloud three times.
Canvas draw_cloud(const PointCloud &cloud, const std::string &title);

} // namespace pmdsim
