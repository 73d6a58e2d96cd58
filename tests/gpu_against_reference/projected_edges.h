#pragma once
// Where a triangle's edges lie in the image, in double.

#include "engine/reference/camera_frame.h"

namespace pmdsim::test {

// Distance in pixels from a sample (column, row in 0 ... S * resolution - 1) to the nearest edge of the
// triangle as the lens projects it; infinity where the whole triangle lies behind the lens.
double pixels_to_edge(const Sensor &sensor, const glm::uvec2 &sample,
                      const reference::CameraTriangle &triangle);

} // namespace pmdsim::test
