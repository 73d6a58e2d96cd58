#pragma once
// For RoundingScope::incidence_cosine, of all that is seen.

#include "engine/error_budget/rounding_bound.h"

#include <algorithm>

namespace pmdsim::test {

// A bound from below over all that is visible, at least grazing_cosine.
inline double least_incidence_cosine(const CameraScene &camera, const SourceGroups &groups,
                                     const std::vector<VisibleBox> &visible) {
  const auto farthest_m = [](const VisibleBox &box) {
    return glm::length(glm::max(glm::abs(box.low_m), glm::abs(box.high_m)));
  };
  VisibleBox diodes;
  for (const SourcePosition &place : groups.positions)
    if (place.number != no_id)
      diodes.add(place.position_m);
  double farthest = 0.0;
  for (const VisibleBox &box : visible)
    farthest = std::max(farthest, farthest_m(box));
  farthest += farthest_m(diodes);
  double least = 1.0;
  for (std::size_t i = 0; i < camera.triangles.size() && least > grazing_cosine; ++i) {
    const Plane &plane = camera.planes[i];
    const glm::dvec3 along_m = glm::min(plane.normal * diodes.low_m, plane.normal * diodes.high_m);
    double range_m = 0.0; // of its corners from the diodes, at most
    for (const glm::dvec3 &corner_m : camera.triangles[i].corners_m)
      range_m = std::max(range_m, farthest_m({diodes.low_m - corner_m, diodes.high_m - corner_m}));
    least =
        std::min(least, (along_m.x + along_m.y + along_m.z - plane.offset_m) / std::min(range_m, farthest));
  }
  return std::max(least, grazing_cosine);
}

} // namespace pmdsim::test
