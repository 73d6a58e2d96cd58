#pragma once
// How far the straight line from a point that a sample sees to a diode is from meeting another answer to
// whether anything blocks it: by brute force over the whole scene, in double, and without asking either
// engine.

#include "engine/model/illuminator.h"
#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/lens_model.h"

#include <vector>

namespace pmdsim::test {

// Two engines that decide by their own rounding may differ within this distance.
inline constexpr double rounding_distance_m = 10e-6;

struct ShadowClearance {
  // From the line to the nearest edge of any triangle, the line's own included, or rim of any disc; 0 where
  // a mask begins or ends within rounding_distance_m of it.
  double edge_m;
  // From either of its ends to the nearest shape but the one that is seen.
  double end_m;
};

class ShadowClearances {
public:
  ShadowClearances(const Scene &scene, const Sensor &sensor, const std::vector<Illuminator> &illuminators);

  // The clearance of a sample that sees the triangle or disc `id`; diodes count through all illuminators.
  ShadowClearance of(const glm::uvec2 &sample, std::uint32_t id, std::size_t diode) const;

private:
  double to_edges_m(const glm::dvec3 &from_m, const glm::dvec3 &to_m) const;
  double to_shapes_m(const glm::dvec3 &point_m, std::uint32_t left_out) const;
  bool mask_changes(const glm::dvec3 &from_m, const glm::dvec3 &to_m, std::uint32_t id) const;

  const Scene &scene_;
  const Sensor &sensor_;
  reference::LensModel lens_;
  std::vector<reference::CameraTriangle> triangles_;
  std::vector<reference::CameraDisc> discs_;
  std::vector<glm::dvec3> diodes_m_;
};

} // namespace pmdsim::test
