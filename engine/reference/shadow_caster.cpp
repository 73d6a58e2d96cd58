#include "engine/reference/shadow_caster.h"

#include "engine/reference/seen_triangle.h"

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

TriangleBlocker blocker_of(const CameraTriangle &triangle, double origin_range_m) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 front = triangle.front();
  const double range_m = std::max({glm::length(a), glm::length(b), glm::length(c)}) + origin_range_m;
  // A needle's cross product is shorter than what it is rounded by.
  const double rounding = height_rounding * glm::length(b - a) * glm::length(c - a);
  return {triangle.corners_m, {front, glm::dot(front, a), rounding, range_m}, triangle.masked};
}

DiscBlocker blocker_of(const CameraDisc &disc, double origin_range_m) {
  const glm::dvec3 axis = disc.axis();
  const ShapePlane plane{axis, glm::dot(axis, disc.centre_m), height_rounding,
                         glm::length(disc.centre_m) + origin_range_m};
  return {disc.centre_m, disc.radius_m, plane, disc.masked};
}

template <class Blocker, class Shape>
std::vector<Blocker> blockers_of(const std::vector<Shape> &shapes, double origin_range_m) {
  std::vector<Blocker> blockers;
  blockers.reserve(shapes.size());
  for (const Shape &shape : shapes)
    blockers.push_back(blocker_of(shape, origin_range_m));
  return blockers;
}

Place place_of(const glm::dvec3 &position_m) { return {position_m, glm::length(position_m)}; }

std::vector<Place> places_of(const std::vector<Light> &lights) {
  std::vector<Place> places;
  for (const Light &light : lights)
    for (const Diode &diode : light.diodes)
      places.push_back(place_of(diode.position_m));
  return places;
}

double farthest_m(const std::vector<Light> &lights) {
  double range_m = 0.0;
  for (const Place &place : places_of(lights))
    range_m = std::max(range_m, place.range_m);
  return range_m;
}

// How much the corners count where the line between two places, on either side of the plane, meets the shape;
// nothing where it passes beside.
std::optional<glm::dvec3> crossing(const TriangleBlocker &triangle, const glm::dvec3 &from_m,
                                   const glm::dvec3 &to_m) {
  const auto &[a, b, c] = triangle.corners_m;
  const SeenTriangle seen(to_m - from_m, {a - from_m, b - from_m, c - from_m});
  return seen.holds_ray() ? std::optional(seen.weights()) : std::nullopt;
}

std::optional<glm::dvec3> crossing(const DiscBlocker &disc, const glm::dvec3 &from_m,
                                   const glm::dvec3 &to_m) {
  const glm::dvec3 way_m = to_m - from_m, to_centre_m = disc.centre_m - from_m;
  const double fraction = glm::dot(disc.plane.normal, to_centre_m) / glm::dot(disc.plane.normal, way_m);
  const double from_centre_m = glm::length(fraction * way_m - to_centre_m);
  return from_centre_m <= disc.radius_m ? std::optional(disc_weights) : std::nullopt;
}

constexpr unsigned packet_size = 16;

} // namespace

int ShapePlane::side_of(const Place &place) const {
  const double height = glm::dot(normal, place.position_m) - offset;
  const double bound = rounding * (range_m + place.range_m);
  return int{height > bound} - int{height < -bound};
}

// The ways from one point to the diodes.
struct ShadowQuery {
  RTCIntersectContext context; // first: Embree hands back a pointer to it
  const ShadowCaster *caster;
  Place point;
  std::uint32_t own_id;

  template <class Blocker>
  void block(const Blocker &blocker, std::uint32_t id, const RTCOccludedFunctionNArguments *args) const {
    const int point_side = id == own_id ? 0 : blocker.plane.side_of(point);
    if (point_side == 0)
      return;
    for (unsigned lane = 0; lane < args->N; ++lane)
      if (args->valid[lane] != 0) {
        const Place &diode = caster->diodes_[RTCRayN_id(args->ray, args->N, lane)];
        if (blocker.plane.side_of(diode) == -point_side && stops_light(blocker, id, diode))
          RTCRayN_tfar(args->ray, args->N, lane) = -std::numeric_limits<float>::infinity();
      }
  }

  template <class Blocker>
  bool stops_light(const Blocker &blocker, std::uint32_t id, const Place &diode) const {
    const auto weights = crossing(blocker, point.position_m, diode.position_m);
    return weights && (!blocker.masked || caster->is_there_(id, *weights));
  }

  static void ask_triangle(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *reinterpret_cast<const ShadowQuery *>(args->context);
    query.block(query.caster->triangles_[args->primID], args->primID, args);
  }

  static void ask_disc(const RTCOccludedFunctionNArguments *args) {
    const auto &query = *reinterpret_cast<const ShadowQuery *>(args->context);
    const auto first_disc = static_cast<std::uint32_t>(query.caster->triangles_.size());
    query.block(query.caster->discs_[args->primID], first_disc + args->primID, args);
  }
};

namespace {

// Rays that Embree traces together.
class Packet {
public:
  bool is_full() const { return size_ == packet_size; }

  void add(std::size_t diode, const glm::dvec3 &from_m, const glm::dvec3 &to_m) {
    const glm::vec3 origin(from_m), direction(to_m - from_m);
    rays_.org_x[size_] = origin.x, rays_.org_y[size_] = origin.y, rays_.org_z[size_] = origin.z;
    rays_.dir_x[size_] = direction.x, rays_.dir_y[size_] = direction.y, rays_.dir_z[size_] = direction.z;
    rays_.tnear[size_] = 0.0f, rays_.tfar[size_] = 1.0f + static_cast<float>(tree_margin);
    rays_.time[size_] = 0.0f;
    rays_.mask[size_] = ~0U;
    rays_.flags[size_] = 0;
    rays_.id[size_] = static_cast<unsigned>(diode);
    valid_[size_++] = -1;
  }

  // Adds the diodes whose rays nothing blocks, and empties the packet.
  void trace(const ShapeTree &tree, ShadowQuery &query, DiodeSet &reached) {
    rtcOccluded16(valid_, tree.get(), &query.context, &rays_);
    for (; size_ > 0; valid_[size_] = 0)
      if (rays_.tfar[--size_] >= 0)
        reached.add(rays_.id[size_]);
  }

private:
  alignas(64) int valid_[packet_size] = {};
  RTCRay16 rays_{};
  unsigned size_ = 0;
};

} // namespace

ShadowCaster::ShadowCaster(const std::vector<CameraTriangle> &triangles, const std::vector<CameraDisc> &discs,
                           const std::vector<Light> &lights, double origin_range_m, IsThere is_there)
    : triangles_(blockers_of<TriangleBlocker>(triangles, origin_range_m)),
      discs_(blockers_of<DiscBlocker>(discs, origin_range_m)), diodes_(places_of(lights)),
      is_there_(std::move(is_there)), tree_(triangles, discs, {.occluded = ShadowQuery::ask_triangle},
                                            {.occluded = ShadowQuery::ask_disc}, farthest_m(lights)) {}

DiodeSet ShadowCaster::reached(const SurfacePoint &point, std::uint32_t id) const {
  ShadowQuery query{};
  rtcInitIntersectContext(&query.context);
  query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  query.caster = this;
  query.point = place_of(point.position_m);
  query.own_id = id;

  DiodeSet reached(diodes_.size());
  Packet packet;
  for (std::size_t diode = 0; diode < diodes_.size(); ++diode) {
    const glm::dvec3 &from_m = diodes_[diode].position_m;
    if (glm::dot(point.normal, from_m - point.position_m) > 0)
      packet.add(diode, from_m, point.position_m);
    if (packet.is_full())
      packet.trace(tree_, query, reached);
  }
  packet.trace(tree_, query, reached);
  return reached;
}

} // namespace pmdsim::reference
