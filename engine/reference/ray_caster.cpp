#include "engine/reference/ray_caster.h"

#include "engine/error.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pmdsim::reference {

namespace {

// Float rounding of rays, boxes and distances is below 1e-6 of the distance from the lens.
constexpr double margin = 1e-5;

struct Query {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  glm::dvec3 direction;
  Hit best{no_id, std::numeric_limits<double>::infinity()};
};

const CameraTriangle &triangle_of(const void *triangles, unsigned id) {
  return static_cast<const CameraTriangle *>(triangles)[id];
}

void padded_bounds(const RTCBoundsFunctionArguments *args) {
  const auto &[a, b, c] = triangle_of(args->geometryUserPtr, args->primID).corners_m;
  const glm::dvec3 pad(margin * std::max({glm::length(a), glm::length(b), glm::length(c)}));
  const glm::vec3 lower(glm::min(glm::min(a, b), c) - pad);
  const glm::vec3 upper(glm::max(glm::max(a, b), c) + pad);
  *args->bounds_o = {lower.x, lower.y, lower.z, 0.0f, upper.x, upper.y, upper.z, 0.0f};
}

void keep_if_nearer(const RTCIntersectFunctionNArguments *args) {
  Query &query = *reinterpret_cast<Query *>(args->context);
  const auto range_m = range_along(query.direction, triangle_of(args->geometryUserPtr, args->primID));
  if (!range_m)
    return;
  Hit &best = query.best;
  if (*range_m < best.range_m || (*range_m == best.range_m && args->primID < best.triangle)) {
    best = {args->primID, *range_m};
    RTCRayN *ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCRayN_tfar(ray, args->N, 0) = static_cast<float>(*range_m * (1.0 + margin));
  }
}

void attach(RTCDevice device, RTCScene scene, const std::vector<CameraTriangle> &triangles) {
  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry(
      rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER), rtcReleaseGeometry);
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(triangles.size()));
  // Embree only hands the pointer back to the two functions here, which read.
  rtcSetGeometryUserData(geometry.get(), const_cast<CameraTriangle *>(triangles.data()));
  rtcSetGeometryBoundsFunction(geometry.get(), padded_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), keep_if_nearer);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

// Rounding keeps order, so the sign is right or the result is zero, and swapping p and q negates it exactly.
double cross(const glm::dvec2 &p, const glm::dvec2 &q) { return p.x * q.y - p.y * q.x; }

// z where several are equally long.
glm::length_t longest_component(const glm::dvec3 &direction) {
  const glm::dvec3 length = glm::abs(direction);
  if (length.z >= length.x && length.z >= length.y)
    return 2;
  return length.y >= length.x ? 1 : 0;
}

} // namespace

RayCaster::RayCaster(std::vector<CameraTriangle> triangles)
    : triangles_(std::move(triangles)), device_(rtcNewDevice(nullptr), rtcReleaseDevice),
      scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  attach(device_.get(), scene_.get(), triangles_);
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    throw Error(ExitCode::out_of_memory, "reference: expected enough memory for the ray caster's tree over " +
                                             std::to_string(triangles_.size()) + " triangles");
}

std::optional<Hit> RayCaster::nearest(const glm::dvec3 &direction) const {
  Query query{};
  rtcInitIntersectContext(&query.context);
  query.direction = direction;

  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &query.context, &ray);

  return query.best.triangle == no_id ? std::nullopt : std::optional(query.best);
}

// After S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", JCGT 2(1), 2013: seen along the
// ray every vertex becomes one point of the plane across the ray's longest component, the same for all
// triangles that share it, and the ray is the plane's origin. As zero counts as inside, no ray slips through
// an edge or a vertex.
std::optional<double> range_along(const glm::dvec3 &direction, const CameraTriangle &triangle) {
  const glm::length_t along = longest_component(direction), u = (along + 1) % 3, v = (along + 2) % 3;
  const glm::dvec2 slope = glm::dvec2(direction[u], direction[v]) / direction[along];
  const auto seen_along_ray = [&](const glm::dvec3 &vertex_m) {
    return glm::dvec2(vertex_m[u], vertex_m[v]) - slope * vertex_m[along];
  };
  const glm::dvec2 a = seen_along_ray(triangle.corners_m[0]);
  const glm::dvec2 b = seen_along_ray(triangle.corners_m[1]);
  const glm::dvec2 c = seen_along_ray(triangle.corners_m[2]);
  const double ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  if (!inside)
    return std::nullopt;

  const glm::dvec3 front = triangle.front();
  const double along_front = glm::dot(front, direction);
  const bool back_seen = along_front > 0;
  if (along_front == 0 || (back_seen && !triangle.double_sided))
    return std::nullopt;

  const double range_m = glm::dot(front, triangle.corners_m[0]) / along_front;
  return range_m > 0 ? std::optional(range_m) : std::nullopt;
}

} // namespace pmdsim::reference
