#include "engine/reference/view/shape_tree.h"

#include "engine/model/error.h"

#include <algorithm>
#include <string>

namespace pmdsim::reference {

namespace {

RTCBounds box_of(const glm::dvec3 &lower, const glm::dvec3 &upper) {
  const glm::vec3 low(lower), high(upper);
  return {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

// Between its origin and a shape, a ray in float strays by the rounding of both places, not of its end.
RTCBounds padded_box(const CameraTriangle &triangle, double origin_reach_m) {
  const auto &[a, b, c] = triangle.corners_m;
  const double reach_m = std::max({glm::length(a), glm::length(b), glm::length(c)});
  const glm::dvec3 pad(tree_margin * (reach_m + origin_reach_m));
  return box_of(glm::min(glm::min(a, b), c) - pad, glm::max(glm::max(a, b), c) + pad);
}

RTCBounds padded_box(const CameraDisc &disc, double origin_reach_m) {
  const glm::dvec3 axis = disc.axis();
  const glm::dvec3 half_m = disc.radius_m * glm::sqrt(glm::max(1.0 - axis * axis, 0.0)) +
                            tree_margin * (glm::length(disc.centre_m) + disc.radius_m + origin_reach_m);
  return box_of(disc.centre_m - half_m, disc.centre_m + half_m);
}

template <class Shape>
std::vector<RTCBounds> padded_boxes(const std::vector<Shape> &shapes, double origin_reach_m) {
  std::vector<RTCBounds> boxes;
  boxes.reserve(shapes.size());
  for (const Shape &shape : shapes)
    boxes.push_back(padded_box(shape, origin_reach_m));
  return boxes;
}

void give_box(const RTCBoundsFunctionArguments *args) {
  *args->bounds_o = static_cast<const RTCBounds *>(args->geometryUserPtr)[args->primID];
}

} // namespace

ShapeTree::ShapeTree(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
                     const ShapeFunctions &of_triangles, const ShapeFunctions &of_discs,
                     double origin_reach_m)
    : device_(rtcNewDevice(nullptr), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  // Embree asks for the boxes before rtcCommitScene returns.
  const std::vector<RTCBounds> triangle_boxes = padded_boxes(triangles, origin_reach_m),
                               disc_boxes = padded_boxes(discs, origin_reach_m);
  attach(triangle_boxes, of_triangles);
  if (!discs.empty())
    attach(disc_boxes, of_discs);
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    throw Error(ExitCode::out_of_memory, "reference: expected enough memory for the ray caster's tree over " +
                                             std::to_string(triangles.size()) + " triangles and " +
                                             std::to_string(discs.size()) + " points");
}

void ShapeTree::attach(const std::vector<RTCBounds> &boxes, const ShapeFunctions &functions) {
  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry(
      rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER), rtcReleaseGeometry);
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(boxes.size()));
  // Embree only hands the pointer back to give_box(), which reads.
  rtcSetGeometryUserData(geometry.get(), const_cast<RTCBounds *>(boxes.data()));
  rtcSetGeometryBoundsFunction(geometry.get(), give_box, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), functions.intersect);
  rtcSetGeometryOccludedFunction(geometry.get(), functions.occluded);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
}

} // namespace pmdsim::reference
