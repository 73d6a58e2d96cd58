#pragma once
// What a ray from the lens sees first. Embree finds the triangles near the ray in float, with room to spare;
// whether the ray hits one, and which is nearest, is decided in double from the triangle's corners and the
// ray's exact direction.

#include "engine/reference/camera_frame.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <optional>
#include <vector>

namespace pmdsim::reference {

struct Hit {
  std::uint32_t triangle;
  double range_m; // from the lens, along the ray
};

class RayCaster {
public:
  // Throws Error: out_of_memory.
  explicit RayCaster(std::vector<CameraTriangle> triangles);

  // The nearest triangle along `direction` (unit length) whose face the lens can see; the lowest id where
  // several are equally near. A ray through the edge that two triangles share hits one of them. Any number of
  // threads may call this at once.
  std::optional<Hit> nearest(const glm::dvec3 &direction) const;

  const CameraTriangle &triangle(std::uint32_t id) const { return triangles_[id]; }

private:
  std::vector<CameraTriangle> triangles_;
  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

// The distance along `direction` (unit length) from the lens to where it passes through `triangle`, edges
// included; nothing where it misses, runs in the triangle's plane or meets a face that the lens cannot see.
std::optional<double> range_along(const glm::dvec3 &direction, const CameraTriangle &triangle);

} // namespace pmdsim::reference
