#include "engine/reference/ray_caster.h"

#include "engine/error.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace pmdsim::reference {

namespace {

// Float rounding of rays, boxes and distances is below 1e-6 of the distance from the lens.
constexpr double margin = 1e-5;

// Rounding keeps order, so the sign is right or the result is zero, and swapping p and q negates it exactly.
double cross(const glm::dvec2 &p, const glm::dvec2 &q) { return p.x * q.y - p.y * q.x; }

// z where several are equally long.
glm::length_t longest_component(const glm::dvec3 &direction) {
  const glm::dvec3 length = glm::abs(direction);
  if (length.z >= length.x && length.z >= length.y)
    return 2;
  return length.y >= length.x ? 1 : 0;
}

// The triangle's corners as seen along the ray, after S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle
// intersection", JCGT 2(1), 2013: every vertex becomes one point of the plane across the ray's longest
// component, the same for all triangles that share it, and the ray is the plane's origin.
struct SeenTriangle {
  // Twice the signed area between the ray and the edge across from each corner.
  double bc, ca, ab;

  SeenTriangle(const glm::dvec3 &direction, const CameraTriangle &triangle) {
    const glm::length_t along = longest_component(direction), u = (along + 1) % 3, v = (along + 2) % 3;
    const glm::dvec2 slope = glm::dvec2(direction[u], direction[v]) / direction[along];
    const auto seen_along_ray = [&](const glm::dvec3 &vertex_m) {
      return glm::dvec2(vertex_m[u], vertex_m[v]) - slope * vertex_m[along];
    };
    const glm::dvec2 a = seen_along_ray(triangle.corners_m[0]);
    const glm::dvec2 b = seen_along_ray(triangle.corners_m[1]);
    const glm::dvec2 c = seen_along_ray(triangle.corners_m[2]);
    ab = cross(a, b), bc = cross(b, c), ca = cross(c, a);
  }

  // As zero counts as inside, no ray slips through an edge or a vertex.
  bool holds_ray() const { return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0); }
};

// The view along the ray keeps ratios of areas, so these are the ones in the triangle itself.
glm::dvec3 weights_along(const glm::dvec3 &direction, const CameraTriangle &triangle) {
  const SeenTriangle seen(direction, triangle);
  const double whole = seen.bc + seen.ca + seen.ab;
  // Rounding may leave nothing of a triangle that is seen from its edge.
  return whole != 0 ? glm::dvec3(seen.bc, seen.ca, seen.ab) / whole : glm::dvec3(1.0 / 3.0);
}

// A disc has no corners but its vertex.
constexpr glm::dvec3 disc_weights(1.0, 0.0, 0.0);

glm::dvec3 weights_along(const glm::dvec3 &, const CameraDisc &) { return disc_weights; }

struct Query {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  glm::dvec3 direction;
  std::uint32_t triangles; // where the discs' ids begin
  const IsThere *is_there;
  Hit best{no_id, std::numeric_limits<double>::infinity()};
};

template <class Shape>
const Shape &shape_of(const void *shapes, unsigned index) {
  return static_cast<const Shape *>(shapes)[index];
}

RTCBounds bounds_of(const glm::dvec3 &lower, const glm::dvec3 &upper) {
  const glm::vec3 low(lower), high(upper);
  return {low.x, low.y, low.z, 0.0f, high.x, high.y, high.z, 0.0f};
}

RTCBounds padded_bounds(const CameraTriangle &triangle) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 pad(margin * std::max({glm::length(a), glm::length(b), glm::length(c)}));
  return bounds_of(glm::min(glm::min(a, b), c) - pad, glm::max(glm::max(a, b), c) + pad);
}

RTCBounds padded_bounds(const CameraDisc &disc) {
  const glm::dvec3 axis = disc.axis();
  const glm::dvec3 reach_m = disc.radius_m * glm::sqrt(glm::max(1.0 - axis * axis, 0.0)) +
                             margin * (glm::length(disc.centre_m) + disc.radius_m);
  return bounds_of(disc.centre_m - reach_m, disc.centre_m + reach_m);
}

template <class Shape>
void give_padded_bounds(const RTCBoundsFunctionArguments *args) {
  *args->bounds_o = padded_bounds(shape_of<Shape>(args->geometryUserPtr, args->primID));
}

std::uint32_t first_id(const Query &, const CameraTriangle &) { return 0; }
std::uint32_t first_id(const Query &query, const CameraDisc &) { return query.triangles; }

template <class Shape>
void keep_if_nearer(const RTCIntersectFunctionNArguments *args) {
  Query &query = *reinterpret_cast<Query *>(args->context);
  const auto &shape = shape_of<Shape>(args->geometryUserPtr, args->primID);
  const auto range_m = range_along(query.direction, shape);
  if (!range_m)
    return;
  const std::uint32_t id = first_id(query, shape) + args->primID;
  Hit &best = query.best;
  const bool nearer = *range_m < best.range_m || (*range_m == best.range_m && id < best.id);
  if (nearer && (!shape.masked || (*query.is_there)(id, weights_along(query.direction, shape)))) {
    best = {id, *range_m};
    RTCRayN *ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCRayN_tfar(ray, args->N, 0) = static_cast<float>(*range_m * (1.0 + margin));
  }
}

template <class Shape>
void attach(RTCDevice device, RTCScene scene, const std::vector<Shape> &shapes) {
  const std::unique_ptr<RTCGeometryTy, decltype(&rtcReleaseGeometry)> geometry(
      rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER), rtcReleaseGeometry);
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(shapes.size()));
  // Embree only hands the pointer back to the two functions here, which read.
  rtcSetGeometryUserData(geometry.get(), const_cast<Shape *>(shapes.data()));
  rtcSetGeometryBoundsFunction(geometry.get(), give_padded_bounds<Shape>, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), keep_if_nearer<Shape>);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

} // namespace

RayCaster::RayCaster(std::vector<CameraTriangle> triangles, std::vector<CameraDisc> discs, IsThere is_there)
    : triangles_(std::move(triangles)), discs_(std::move(discs)), is_there_(std::move(is_there)),
      device_(rtcNewDevice(nullptr), rtcReleaseDevice), scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  attach(device_.get(), scene_.get(), triangles_);
  if (!discs_.empty())
    attach(device_.get(), scene_.get(), discs_);
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    throw Error(ExitCode::out_of_memory, "reference: expected enough memory for the ray caster's tree over " +
                                             std::to_string(triangles_.size()) + " triangles and " +
                                             std::to_string(discs_.size()) + " points");
}

std::optional<Hit> RayCaster::nearest(const glm::dvec3 &direction) const {
  Query query{};
  rtcInitIntersectContext(&query.context);
  query.direction = direction;
  query.triangles = static_cast<std::uint32_t>(triangles_.size());
  query.is_there = &is_there_;

  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_.get(), &query.context, &ray);

  return query.best.id == no_id ? std::nullopt : std::optional(query.best);
}

glm::dvec3 RayCaster::weights(const glm::dvec3 &direction, std::uint32_t id) const {
  return id < triangles_.size() ? weights_along(direction, triangles_[id]) : disc_weights;
}

glm::dvec3 RayCaster::normal(const glm::dvec3 &direction, std::uint32_t id) const {
  if (id >= triangles_.size())
    return -discs_[id - triangles_.size()].axis();
  const glm::dvec3 front = glm::normalize(triangles_[id].front());
  return glm::dot(front, direction) < 0 ? front : -front;
}

std::optional<double> range_along(const glm::dvec3 &direction, const CameraTriangle &triangle) {
  if (!SeenTriangle(direction, triangle).holds_ray())
    return std::nullopt;

  const glm::dvec3 front = triangle.front();
  const double along_front = glm::dot(front, direction);
  const bool back_seen = along_front > 0;
  if (along_front == 0 || (back_seen && !triangle.double_sided))
    return std::nullopt;

  const double range_m = glm::dot(front, triangle.corners_m[0]) / along_front;
  return range_m > 0 ? std::optional(range_m) : std::nullopt;
}

std::optional<double> range_along(const glm::dvec3 &direction, const CameraDisc &disc) {
  const double distance_m = glm::length(disc.centre_m);
  const double cosine = glm::dot(disc.axis(), direction);
  if (distance_m == 0 || cosine <= 0)
    return std::nullopt;
  const double range_m = distance_m / cosine;
  const double from_centre_m = glm::length(range_m * direction - disc.centre_m);
  return from_centre_m <= disc.radius_m ? std::optional(range_m) : std::nullopt;
}

} // namespace pmdsim::reference
