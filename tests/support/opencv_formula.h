#pragma once
// OpenCV's published camera model (documentation of calib3d and of its namespace fisheye), written out on its
// own: from a point of the camera's frame to its pixel.

#include "engine/model/sensor.h"

#include <cmath>
#include <glm/glm.hpp>

namespace pmdsim::test {

// x'', y'' of the point (X, Y, Z) with the distortion coefficients k1, k2, p1, p2, k3.
inline glm::dvec2 opencv_distorted(const glm::dvec3 &point, const BrownConrady &d) {
  const double x = point.x / point.z, y = point.y / point.z;
  const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
  const double radial = 1 + d.k1 * r2 + d.k2 * r4 + d.k3 * r6;
  return {x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x),
          y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y};
}

// fisheye: x' = (theta_d / r) a with a = X/Z, r^2 = a^2 + b^2, theta = atan r; beyond 90 degrees, where
// OpenCV ends, theta goes on as the angle to the axis.
inline glm::dvec2 opencv_distorted(const glm::dvec3 &point, const Fisheye &d) {
  const double across = std::hypot(point.x, point.y);
  const double theta = std::atan2(across, point.z);
  const double theta_d = theta * (1 + d.k1 * std::pow(theta, 2) + d.k2 * std::pow(theta, 4) +
                                  d.k3 * std::pow(theta, 6) + d.k4 * std::pow(theta, 8));
  return across > 0 ? glm::dvec2(point) * (theta_d / across) : glm::dvec2(0.0);
}

// u = fx x'' + cx, v = fy y'' + cy with fx, fy the image distance in pixels and cx, cy half the resolution:
// u, v count from the image's corner, half a pixel more than OpenCV, which counts from the first pixel's
// centre.
template <typename Model>
glm::dvec2 opencv_pixel(const glm::dvec3 &point, const Model &distortion, const Sensor &sensor) {
  return opencv_distorted(point, distortion) * (sensor.image_distance_m() / sensor.pixel_pitch_m) +
         0.5 * glm::dvec2(sensor.resolution);
}

} // namespace pmdsim::test
