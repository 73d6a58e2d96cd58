#pragma once
// Rays from surface to surface and from surfaces to diodes. Embree meets the triangles in float, which moves
// where a ray ends by less than a path's chance does; the point hit is then found in double. Discs are not
// there: each of them faces the lens, and has no side for light from elsewhere.

#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/shape_tree.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <optional>
#include <vector>

namespace pmdsim::reference {

struct BounceHit {
  std::uint32_t id; // of a triangle
  glm::dvec3 position_m;
  glm::dvec3 weights; // how much each corner counts there
};

struct BounceQuery;

// Where a ray starts: a point of a surface and the unit normal on the side that the ray leaves from.
struct RayStart {
  glm::dvec3 position_m, normal;
};

class BounceCaster {
public:
  // Keeps a reference to the triangles. `is_there` is asked about cutouts shapes only. Throws Error:
  // out_of_memory.
  BounceCaster(const std::vector<CameraTriangle> &triangles, IsThere is_there);

  // The nearest triangle along `direction` (unit length), whichever side it shows. Any number of threads may
  // call this at once.
  std::optional<BounceHit> nearest(const RayStart &start, const glm::dvec3 &direction) const;
  // Whether no triangle lies on the way to a diode.
  bool is_free(const RayStart &start, const glm::dvec3 &diode_m) const;

  const std::vector<CameraTriangle> &triangles() const { return triangles_; }

private:
  friend BounceQuery;
  void attach_triangles();
  RTCRay ray_from(const RayStart &start) const;

  const std::vector<CameraTriangle> &triangles_;
  IsThere is_there_;
  glm::dvec3 middle_m_; // of the triangles' box: Embree's coordinates begin there
  double lift_m_;       // how far off the surface rays start
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

} // namespace pmdsim::reference
