#pragma once
// The sensor's lens and chip as OpenCV describes a camera.

#include "engine/sensor.h"

namespace pmdsim {

// Pinhole without distortion, in pixels; the CENTRE of pixel (0, 0) lies at (0, 0), so that a chip centred on
// the axis has cx = (columns - 1) / 2. A point (x, y, z) of the camera frame appears at u = fx x/z + cx, v =
// fy y/z + cy. The focal lengths follow from the image distance S2, not from the lens's own focal length.
struct Intrinsics {
  double fx, fy, cx, cy;
};

Intrinsics intrinsics_of(const Sensor &sensor);

} // namespace pmdsim
