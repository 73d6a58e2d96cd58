#pragma once
// The sensor's lens and chip as OpenCV describes a camera.

#include "engine/model/sensor.h"

#include <array>
#include <string>
#include <vector>

namespace pmdsim {

// A point (X, Y, Z) of the camera frame appears at the pixel camera_matrix * (x''', y''', 1), where (x''',
// y''') comes from the slopes (X/Z, Y/Z) by OpenCV's distortion and then its tilted sensor, tauX = alpha,
// tauY = beta of eq. 1; gamma is a rotation within camera_matrix, whose last row is 0, 0, 1. The CENTRE of
// pixel (0, 0) lies at (0, 0). Focal lengths follow from the image distance S2, not from the lens's own focal
// length.
struct Intrinsics {
  std::string model; // "pinhole", "brown" or "fisheye"
  std::array<std::array<double, 3>, 3> camera_matrix;
  bool rotated; // gamma is not 0: camera_matrix has four figures where OpenCV expects fx, fy alone
  // OpenCV's order. Pinhole and brown: k1, k2, p1, p2, k3, with a tilt all 14, of which tauX, tauY are the
  // last. Fisheye: k1 to k4; OpenCV's has no tilt.
  std::vector<double> distortion;
  glm::dvec2 tilt_rad; // tauX, tauY
};

Intrinsics intrinsics_of(const Sensor &sensor);

} // namespace pmdsim
