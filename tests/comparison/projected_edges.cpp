#include "tests/comparison/projected_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pmdsim::test {

namespace {

double angle_rad(const glm::dvec3 &a, const glm::dvec3 &b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Between a ray and the nearest point of an edge, as seen from the lens.
double angle_to_edge_rad(const glm::dvec3 &ray, const glm::dvec3 &from_m, const glm::dvec3 &to_m) {
  const glm::dvec3 normal = glm::cross(from_m, to_m);
  const bool beside =
      glm::dot(glm::cross(normal, from_m), ray) > 0 && glm::dot(glm::cross(to_m, normal), ray) > 0;
  if (beside)
    return std::abs(std::asin(std::clamp(glm::dot(glm::normalize(normal), ray), -1.0, 1.0)));
  return std::min(angle_rad(ray, from_m), angle_rad(ray, to_m));
}

// The angle that a pixel takes, between the same samples of it and of the nearest neighbour; a single pixel
// counts as half a turn.
double pixel_angle_rad(const reference::LensModel &lens, const Sensor &sensor, const glm::uvec2 &sample) {
  double smallest_rad = std::acos(-1.0);
  for (const glm::uvec2 step : {glm::uvec2(sensor.samples, 0), glm::uvec2(0, sensor.samples)}) {
    const bool has_next = glm::all(glm::lessThan(sample + step, sensor.resolution * sensor.samples));
    if (!has_next && glm::any(glm::lessThan(sample, step)))
      continue;
    if (const auto next = lens.sample_ray(has_next ? sample + step : sample - step))
      smallest_rad = std::min(smallest_rad, angle_rad(*lens.sample_ray(sample), *next));
  }
  return smallest_rad;
}

} // namespace

double pixels_to_edge(const reference::LensModel &lens, const Sensor &sensor, const glm::uvec2 &sample,
                      const reference::CameraTriangle &triangle) {
  const auto ray = lens.sample_ray(sample);
  if (!ray)
    return std::numeric_limits<double>::infinity();
  const auto &[a, b, c] = triangle.corners_m;
  const double nearest_rad =
      std::min({angle_to_edge_rad(*ray, a, b), angle_to_edge_rad(*ray, b, c), angle_to_edge_rad(*ray, c, a)});
  return nearest_rad / pixel_angle_rad(lens, sensor, sample);
}

double pixels_to_rim(const reference::LensModel &lens, const Sensor &sensor, const glm::uvec2 &sample,
                     const glm::dvec3 &centre_m, double radius_m) {
  const double off_centre_rad = angle_rad(*lens.sample_ray(sample), centre_m);
  const double rim_rad = std::atan2(radius_m, glm::length(centre_m));
  return std::abs(off_centre_rad - rim_rad) / pixel_angle_rad(lens, sensor, sample);
}

} // namespace pmdsim::test
