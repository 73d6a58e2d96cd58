#include "engine/reference/view/ray_caster.h"

#include <limits>
#include <utility>

namespace pmdsim::reference {

namespace {

// A ray from the lens: corners are from its origin as they are.
glm::dvec3 weights_along(const glm::dvec3 &direction, const CameraTriangle &triangle) {
  return SeenTriangle(direction, triangle.corners_m).weights();
}
glm::dvec3 weights_along(const glm::dvec3 &, const CameraDisc &) { return disc_weights; }

struct Query {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  glm::dvec3 direction;
  const std::vector<CameraTriangle> *triangles;
  const std::vector<CameraDisc> *discs;
  const IsThere *is_there;
  Hit best{no_id, std::numeric_limits<double>::infinity()};
};

template <class Shape>
void keep_if_nearer(Query &query, const Shape &shape, std::uint32_t id,
                    const RTCIntersectFunctionNArguments *args) {
  const auto range_m = range_along(query.direction, shape);
  if (!range_m)
    return;
  Hit &best = query.best;
  const bool nearer = *range_m < best.range_m || (*range_m == best.range_m && id < best.id);
  if (nearer && (!shape.cutouts || (*query.is_there)(id, weights_along(query.direction, shape)))) {
    best = {id, *range_m};
    RTCRayN *ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCRayN_tfar(ray, args->N, 0) = static_cast<float>(*range_m * (1.0 + tree_margin));
  }
}

void keep_nearer_triangle(const RTCIntersectFunctionNArguments *args) {
  Query &query = *reinterpret_cast<Query *>(args->context);
  keep_if_nearer(query, (*query.triangles)[args->primID], args->primID, args);
}

void keep_nearer_disc(const RTCIntersectFunctionNArguments *args) {
  Query &query = *reinterpret_cast<Query *>(args->context);
  const auto first_disc = static_cast<std::uint32_t>(query.triangles->size());
  keep_if_nearer(query, (*query.discs)[args->primID], first_disc + args->primID, args);
}

} // namespace

RayCaster::RayCaster(std::vector<CameraTriangle> triangles, std::vector<CameraDisc> discs, IsThere is_there)
    : triangles_(std::move(triangles)), discs_(std::move(discs)), is_there_(std::move(is_there)),
      tree_(triangles_, discs_, {.intersect = keep_nearer_triangle}, {.intersect = keep_nearer_disc}) {}

std::optional<Hit> RayCaster::nearest(const glm::dvec3 &direction) const {
  Query query{};
  rtcInitIntersectContext(&query.context);
  query.direction = direction;
  query.triangles = &triangles_;
  query.discs = &discs_;
  query.is_there = &is_there_;

  RTCRayHit ray{};
  ray.ray.dir_x = static_cast<float>(direction.x);
  ray.ray.dir_y = static_cast<float>(direction.y);
  ray.ray.dir_z = static_cast<float>(direction.z);
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(tree_.get(), &query.context, &ray);

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
  if (!SeenTriangle(direction, triangle.corners_m).holds_ray())
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
