#pragma once
// Embree's tree over the shapes of a scene. It works in float and finds the shapes near a ray, with room to
// spare; its callers decide in double.

#include "engine/reference/view/camera_frame.h"

#include <array>
#include <cstdint>
#include <embree3/rtcore.h>
#include <functional>
#include <memory>
#include <vector>

namespace pmdsim::reference {

// Float rounding of rays, boxes and distances is below 1e-6 of the distance from the lens.
inline constexpr double tree_margin = 1e-5;

// The functions by which Embree asks about a shape whose box a ray meets; null where rays of that kind are
// not cast.
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

// Whether a cutouts shape is there where its corners count `weights`.
using IsThere = std::function<bool(std::uint32_t id, const glm::dvec3 &weights)>;

// A triangle as a ray sees it, so that no ray slips between neighbours. After S. Woop, C. Benthin, I. Wald,
// "Watertight ray/triangle intersection", JCGT 2(1), 2013: every vertex becomes one point of the plane across
// the ray's longest component, the same for all triangles that share it, and the ray is the plane's origin.
class SeenTriangle {
public:
  // `corners_m` from the ray's origin; `direction` of any length but 0.
  SeenTriangle(const glm::dvec3 &direction, const std::array<glm::dvec3, 3> &corners_m) {
    const glm::length_t along = longest_component(direction), u = (along + 1) % 3, v = (along + 2) % 3;
    const glm::dvec2 slope = glm::dvec2(direction[u], direction[v]) / direction[along];
    const auto seen_along_ray = [&](const glm::dvec3 &vertex_m) {
      return glm::dvec2(vertex_m[u], vertex_m[v]) - slope * vertex_m[along];
    };
    const glm::dvec2 a = seen_along_ray(corners_m[0]), b = seen_along_ray(corners_m[1]),
                     c = seen_along_ray(corners_m[2]);
    ab_ = cross(a, b), bc_ = cross(b, c), ca_ = cross(c, a);
  }

  // Whether the triangle holds the line through the ray, which reaches both ways. As zero counts as inside,
  // no ray slips through an edge or a vertex.
  bool holds_ray() const { return (ab_ >= 0 && bc_ >= 0 && ca_ >= 0) || (ab_ <= 0 && bc_ <= 0 && ca_ <= 0); }

  // How much each corner counts where the ray meets the triangle. The view along the ray keeps ratios of
  // areas, so these are the ones in the triangle itself.
  glm::dvec3 weights() const {
    const double whole = bc_ + ca_ + ab_;
    // Rounding may leave nothing of a triangle that is seen from its edge.
    return whole != 0 ? glm::dvec3(bc_, ca_, ab_) / whole : glm::dvec3(1.0 / 3.0);
  }

private:
  // Rounding keeps order, so the sign is right or the result is zero, and swapping p and q negates it
  // exactly.
  static double cross(const glm::dvec2 &p, const glm::dvec2 &q) { return p.x * q.y - p.y * q.x; }

  // z where several are equally long.
  static glm::length_t longest_component(const glm::dvec3 &direction) {
    const glm::dvec3 length = glm::abs(direction);
    if (length.z >= length.x && length.z >= length.y)
      return 2;
    return length.y >= length.x ? 1 : 0;
  }

  // Twice the signed area between the ray and the edge across from each corner.
  double bc_, ca_, ab_;
};

// A disc has no corners but its vertex.
inline constexpr glm::dvec3 disc_weights(1.0, 0.0, 0.0);

} // namespace pmdsim::reference
