#include "tests/gpu_against_reference/projected_edges.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace pmdsim::test {

namespace {

using Edge = std::pair<glm::dvec3, glm::dvec3>;

// The part of the edge in front of the lens; so little behind this depth is left out that it lies outside any
// image.
std::optional<Edge> in_front(Edge edge) {
  auto &[from, to] = edge;
  if (from.z > to.z)
    std::swap(from, to);
  const double nearest_z_m = 1e-6 * glm::length(to);
  if (to.z <= nearest_z_m)
    return std::nullopt;
  if (from.z < nearest_z_m)
    from = glm::mix(from, to, (nearest_z_m - from.z) / (to.z - from.z));
  return edge;
}

glm::dvec2 pixels_from_centre(const Sensor &sensor, const glm::dvec3 &point_m) {
  return glm::dvec2(point_m) / point_m.z * sensor.image_distance_m() / sensor.pixel_pitch_m;
}

double distance_to_segment(const glm::dvec2 &point, const glm::dvec2 &from, const glm::dvec2 &to) {
  const glm::dvec2 along = to - from;
  const double length_squared = glm::dot(along, along);
  const double nearest =
      length_squared > 0 ? std::clamp(glm::dot(point - from, along) / length_squared, 0.0, 1.0) : 0;
  return glm::length(point - glm::mix(from, to, nearest));
}

} // namespace

double pixels_to_edge(const Sensor &sensor, const glm::uvec2 &sample,
                      const reference::CameraTriangle &triangle) {
  const glm::dvec2 seen_at = pixels_from_centre(sensor, reference::sample_ray(sensor, sample));
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i)
    if (const auto edge = in_front({triangle.corners_m[i], triangle.corners_m[(i + 1) % 3]}))
      nearest = std::min(nearest, distance_to_segment(seen_at, pixels_from_centre(sensor, edge->first),
                                                      pixels_from_centre(sensor, edge->second)));
  return nearest;
}

} // namespace pmdsim::test
