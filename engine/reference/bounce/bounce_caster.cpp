#include "engine/reference/bounce/bounce_caster.h"

#include "engine/model/error.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace pmdsim::reference {

namespace {

// Of the triangles' extent. Some ten times what float moves a ray's start and the triangles by.
constexpr double lift_per_extent = 2e-6;

struct Box {
  glm::dvec3 lower_m{std::numeric_limits<double>::infinity()};
  glm::dvec3 upper_m{-std::numeric_limits<double>::infinity()};
};

Box box_around(const std::vector<CameraTriangle> &triangles) {
  Box box;
  for (const CameraTriangle &triangle : triangles)
    for (const glm::dvec3 &corner_m : triangle.corners_m) {
      box.lower_m = glm::min(box.lower_m, corner_m);
      box.upper_m = glm::max(box.upper_m, corner_m);
    }
  return triangles.empty() ? Box{glm::dvec3(0.0), glm::dvec3(0.0)} : box;
}

glm::dvec3 weights_of(double second, double third) { return {1.0 - second - third, second, third}; }

} // namespace

// A ray under way.
struct BounceQuery {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  const BounceCaster *caster;

  explicit BounceQuery(const BounceCaster &of) : caster(&of) { rtcInitIntersectContext(&context); }

  // Lets the ray pass where a mask leaves the surface out.
  static void skip_cutouts(const RTCFilterFunctionNArguments *args) {
    const BounceCaster &caster = *reinterpret_cast<const BounceQuery *>(args->context)->caster;
    const std::uint32_t id = RTCHitN_primID(args->hit, args->N, 0);
    const glm::dvec3 weights = weights_of(RTCHitN_u(args->hit, args->N, 0), RTCHitN_v(args->hit, args->N, 0));
    if (caster.triangles_[id].cutouts && !caster.is_there_(id, weights))
      args->valid[0] = 0;
  }
};

BounceCaster::BounceCaster(const std::vector<CameraTriangle> &triangles, IsThere is_there)
    : triangles_(triangles), is_there_(std::move(is_there)), device_(rtcNewDevice(nullptr), rtcReleaseDevice),
      scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
  const Box box = box_around(triangles);
  middle_m_ = 0.5 * (box.lower_m + box.upper_m);
  lift_m_ = lift_per_extent * glm::length(box.upper_m - box.lower_m);
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  if (!triangles.empty())
    attach_triangles();
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    throw Error(ExitCode::out_of_memory, "reference: expected enough memory for bounces among " +
                                             std::to_string(triangles.size()) + " triangles");
}

void BounceCaster::attach_triangles() {
  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry(
      rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE), rtcReleaseGeometry);
  auto *corners = static_cast<glm::vec3 *>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                   RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                                                   3 * triangles_.size()));
  auto *indices = static_cast<glm::uvec3 *>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), triangles_.size()));
  if (corners == nullptr || indices == nullptr)
    return; // an error of the device
  for (std::size_t id = 0; id < triangles_.size(); ++id) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      corners[3 * id + corner] = glm::vec3(triangles_[id].corners_m[corner] - middle_m_);
    indices[id] = static_cast<unsigned>(3 * id) + glm::uvec3(0, 1, 2);
  }
  if (std::ranges::any_of(triangles_, &CameraTriangle::cutouts)) {
    rtcSetGeometryIntersectFilterFunction(geometry.get(), BounceQuery::skip_cutouts);
    rtcSetGeometryOccludedFilterFunction(geometry.get(), BounceQuery::skip_cutouts);
  }
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene_.get(), geometry.get());
}

RTCRay BounceCaster::ray_from(const RayStart &start) const {
  const glm::vec3 origin(start.position_m + lift_m_ * start.normal - middle_m_);
  RTCRay ray{};
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = ~0U;
  return ray;
}

std::optional<BounceHit> BounceCaster::nearest(const RayStart &start, const glm::dvec3 &direction) const {
  BounceQuery query(*this);
  RTCRayHit ray{};
  ray.ray = ray_from(start);
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &query.context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
    return std::nullopt;
  // From the corners, which leaves the point on the triangle's plane and within it however the ray grazes it.
  const glm::dvec3 weights = weights_of(ray.hit.u, ray.hit.v);
  const auto &[a, b, c] = triangles_[ray.hit.primID].corners_m;
  return BounceHit{ray.hit.primID, weights[0] * a + weights[1] * b + weights[2] * c, weights};
}

bool BounceCaster::is_free(const RayStart &start, const glm::dvec3 &diode_m) const {
  BounceQuery query(*this);
  const glm::dvec3 way_m = diode_m - start.position_m;
  RTCRay ray = ray_from(start);
  ray.dir_x = static_cast<float>(way_m.x);
  ray.dir_y = static_cast<float>(way_m.y);
  ray.dir_z = static_cast<float>(way_m.z);
  // What touches the diode does not block.
  ray.tfar = static_cast<float>(1.0 - lift_m_ / glm::length(way_m));
  rtcOccluded1(scene_.get(), &query.context, &ray);
  return ray.tfar >= 0;
}

} // namespace pmdsim::reference
