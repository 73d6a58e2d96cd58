#include "engine/reference/shadow/shadow_caster.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace pmdsim::reference {

namespace {

// Rounding of a height above a plane: of the place itself, which was found on some plane, of the shape's
// corners and their cross product, and of the height's own terms. Some ten half units in the last place in
// all.
constexpr double height_rounding = 8 * std::numeric_limits<double>::epsilon();

ShapePlane plane_of(const CameraTriangle &triangle, double origin_range_m) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 front = triangle.front();
  const double range_m = std::max({glm::length(a), glm::length(b), glm::length(c)}) + origin_range_m;
  // A needle's cross product is shorter than what it is rounded by.
  const double rounding = height_rounding * glm::length(b - a) * glm::length(c - a);
  return {front, glm::dot(front, a), rounding, range_m};
}

ShapePlane plane_of(const CameraDisc &disc, double origin_range_m) {
  const glm::dvec3 axis = disc.axis();
  return {axis, glm::dot(axis, disc.centre_m), height_rounding, glm::length(disc.centre_m) + origin_range_m};
}

template <class Shape>
std::vector<Blocker<Shape>> blockers_of(const std::vector<Shape> &shapes, double origin_range_m) {
  std::vector<Blocker<Shape>> blockers;
  blockers.reserve(shapes.size());
  for (const Shape &shape : shapes)
    blockers.push_back({shape, plane_of(shape, origin_range_m)});
  return blockers;
}

Place place_of(const glm::dvec3 &position_m) { return {position_m, glm::length(position_m)}; }

std::vector<Place> positions_of(const std::vector<Light> &lights) {
  std::vector<Place> places;
  for (const Light &light : lights)
    for (const Diode &diode : light.diodes)
      places.push_back(place_of(diode.position_m));
  return places;
}

double farthest_m(const std::vector<Place> &places) {
  double range_m = 0.0;
  for (const Place &place : places)
    range_m = std::max(range_m, place.range_m);
  return range_m;
}

// How much the corners count where the line between two places, on either side of the plane, meets the shape;
// nothing where it passes beside.
std::optional<glm::dvec3> crossing(const Blocker<CameraTriangle> &triangle, const glm::dvec3 &from_m,
                                   const glm::dvec3 &to_m) {
  const auto &[a, b, c] = triangle.shape.corners_m;
  const SeenTriangle seen(to_m - from_m, {a - from_m, b - from_m, c - from_m});
  return seen.holds_ray() ? std::optional(seen.weights()) : std::nullopt;
}

std::optional<glm::dvec3> crossing(const Blocker<CameraDisc> &disc, const glm::dvec3 &from_m,
                                   const glm::dvec3 &to_m) {
  const glm::dvec3 way_m = to_m - from_m, to_centre_m = disc.shape.centre_m - from_m;
  const double fraction = glm::dot(disc.plane.normal, to_centre_m) / glm::dot(disc.plane.normal, way_m);
  const double from_centre_m = glm::length(fraction * way_m - to_centre_m);
  return from_centre_m <= disc.shape.radius_m ? std::optional(disc_weights) : std::nullopt;
}

} // namespace

int ShapePlane::side_of(const Place &place) const {
  const double height = glm::dot(normal, place.position_m) - offset;
  const double bound = rounding * (range_m + place.range_m);
  return int{height > bound} - int{height < -bound};
}

// The way between a point and a diode.
struct ShadowQuery {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  const ShadowCaster *caster;
  Place point, diode;
  std::uint32_t own_id;

  template <class Shape>
  void ask(const Blocker<Shape> &blocker, std::uint32_t id, const RTCOccludedFunctionNArguments *args) const {
    if (id != own_id && blocks(blocker, id))
      RTCRayN_tfar(args->ray, args->N, 0) = -std::numeric_limits<float>::infinity();
  }

  template <class Shape>
  bool blocks(const Blocker<Shape> &blocker, std::uint32_t id) const {
    const int point_side = blocker.plane.side_of(point);
    if (point_side == 0 || blocker.plane.side_of(diode) != -point_side)
      return false;
    const auto weights = crossing(blocker, point.position_m, diode.position_m);
    return weights && (!blocker.shape.cutouts || caster->is_there_(id, *weights));
  }

  static void ask_triangle(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *reinterpret_cast<const ShadowQuery *>(args->context);
    query.ask(query.caster->triangles_[args->primID], args->primID, args);
  }

  static void ask_disc(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *reinterpret_cast<const ShadowQuery *>(args->context);
    const auto first_disc = static_cast<std::uint32_t>(query.caster->triangles_.size());
    query.ask(query.caster->discs_[args->primID], first_disc + args->primID, args);
  }
};

ShadowCaster::ShadowCaster(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
                           const std::vector<Light> &lights, double origin_range_m, IsThere is_there)
    : triangles_(blockers_of(triangles, origin_range_m)), discs_(blockers_of(discs, origin_range_m)),
      diodes_(positions_of(lights)), is_there_(std::move(is_there)),
      tree_(triangles, discs, {.occluded = ShadowQuery::ask_triangle}, {.occluded = ShadowQuery::ask_disc},
            farthest_m(diodes_)) {}

DiodeSet ShadowCaster::reached(const SurfacePoint &point, std::uint32_t id) const {
  ShadowQuery query{};
  rtcInitIntersectContext(&query.context);
  query.caster = this;
  query.point = place_of(point.position_m);
  query.own_id = id;

  DiodeSet reached(diodes_.size());
  for (std::size_t diode = 0; diode < diodes_.size(); ++diode) {
    query.diode = diodes_[diode];
    if (glm::dot(point.normal, query.diode.position_m - point.position_m) > 0 && !is_blocked(query))
      reached.add(diode);
  }
  return reached;
}

// From the diode to the point: see ShapeTree about where rays start.
bool ShadowCaster::is_blocked(ShadowQuery &query) const {
  const glm::vec3 origin(query.diode.position_m), way(query.point.position_m - query.diode.position_m);
  RTCRay ray{};
  ray.org_x = origin.x, ray.org_y = origin.y, ray.org_z = origin.z;
  ray.dir_x = way.x, ray.dir_y = way.y, ray.dir_z = way.z;
  ray.tfar = 1.0f + static_cast<float>(tree_margin);
  ray.mask = ~0U;
  rtcOccluded1(tree_.get(), &query.context, &ray);
  return ray.tfar < 0;
}

} // namespace pmdsim::reference
