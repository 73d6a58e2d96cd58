#pragma once
// Embree's tree over the shapes of a scene. It works in float and finds the shapes near a ray, with room to
// spare; its callers decide in double.

#include "engine/reference/view/camera_frame.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <functional>
#include <memory>
#include <vector>

namespace pmdsim::reference {

// Float rounding of rays, boxes and distances is below 1e-6 of the distance from the lens.
inline constexpr double tree_margin = 1e-5;

// What Embree asks about a shape whose box a ray meets; nothing where rays of that kind are not cast.
struct ShapeFunctions {
  RTCIntersectFunctionN intersect = nullptr;
  RTCOccludedFunctionN occluded = nullptr;
};

// Triangles are geometry 0, discs geometry 1, each with its index as primitive.
class ShapeTree {
public:
  // For rays that start within `origin_reach_m` of the lens: then a ray that meets a shape meets its box,
  // however far it goes. Throws Error: out_of_memory.
  ShapeTree(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
            const ShapeFunctions &of_triangles, const ShapeFunctions &of_discs, double origin_reach_m = 0.0);

  RTCScene get() const { return scene_.get(); }

private:
  void attach(const std::vector<RTCBounds> &boxes, const ShapeFunctions &functions);

  std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)> device_;
  std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)> scene_;
};

// Whether a masked shape is there where its corners count `weights`.
using IsThere = std::function<bool(std::uint32_t id, const glm::dvec3 &weights)>;

// A disc has no corners but its vertex.
inline constexpr glm::dvec3 disc_weights(1.0, 0.0, 0.0);

} // namespace pmdsim::reference
