#include "engine/passes/occluders.h"

#include "engine/passes/convex_bodies.h"
#include "engine/passes/double_pair.h"
#include "engine/passes/vertex_order.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace pmdsim {
namespace {

// Of doubles that went through a rotation and a dot product; nothing is that thin.
constexpr double rounding = 1e-14;

struct Box {
  glm::dvec3 low_m{std::numeric_limits<double>::infinity()}, high_m{-low_m};

  void add(const glm::dvec3 &p) {
    low_m = glm::min(low_m, p);
    high_m = glm::max(high_m, p);
  }
};

// On which sides of a plane anything lies.
struct Sides {
  bool front = false, back = false;
};

// A plane and what heights over it may be off by, beside the rounding of the height itself.
struct RoundedPlane {
  Plane plane;
  double rounding_m;
};

void add_side(Sides &sides, const RoundedPlane &of, const glm::dvec3 &p) {
  const double height_m = glm::dot(of.plane.normal, p) - of.plane.offset_m;
  const double rounding_m = of.rounding_m + rounding * (std::abs(of.plane.offset_m) + std::abs(p.x) +
                                                        std::abs(p.y) + std::abs(p.z));
  sides.front = sides.front || height_m > rounding_m;
  sides.back = sides.back || height_m < -rounding_m;
}

// Of a box, at most.
Sides sides_of(const RoundedPlane &plane, const Box &box) {
  const glm::bvec3 up = glm::greaterThan(plane.plane.normal, glm::dvec3(0.0));
  Sides sides;
  add_side(sides, plane, glm::mix(box.low_m, box.high_m, up));
  add_side(sides, plane, glm::mix(box.high_m, box.low_m, up));
  return sides;
}

// Points that are asked about many planes: in chunks, each with its box.
class PointSet {
public:
  void add_chunk(std::vector<glm::dvec3> points_m) {
    chunks_.push_back({Box{}, std::move(points_m)});
    for (const glm::dvec3 &p : chunks_.back().points_m)
      chunks_.back().box.add(p);
  }

  Sides sides(const RoundedPlane &plane) const {
    Sides all;
    for (const Chunk &chunk : chunks_) {
      const Sides box = sides_of(plane, chunk.box);
      if ((box.front && !all.front) || (box.back && !all.back))
        for (const glm::dvec3 &p : chunk.points_m)
          add_side(all, plane, p);
      if (all.front && all.back)
        break;
    }
    return all;
  }

private:
  struct Chunk {
    Box box;
    std::vector<glm::dvec3> points_m;
  };
  std::vector<Chunk> chunks_;
};

// The corners of all that the lens sees.
PointSet seen_corners(const CameraScene &camera) {
  constexpr std::size_t most_chunks = 256;
  const std::size_t per_chunk = camera.triangles.size() / most_chunks + 1;
  PointSet points;
  for (std::size_t first = 0; first < camera.triangles.size(); first += per_chunk) {
    std::vector<glm::dvec3> corners_m;
    for (std::size_t i = first; i < std::min(first + per_chunk, camera.triangles.size()); ++i)
      corners_m.insert(corners_m.end(), camera.triangles[i].corners_m.begin(),
                       camera.triangles[i].corners_m.end());
    points.add_chunk(std::move(corners_m));
  }
  return points;
}

PointSet all_diodes(const std::vector<CameraIlluminator> &illuminators) {
  PointSet points;
  for (const CameraIlluminator &illuminator : illuminators) {
    std::vector<glm::dvec3> positions_m;
    for (const Diode &diode : illuminator.diodes)
      positions_m.push_back(diode.position_m);
    points.add_chunk(std::move(positions_m));
  }
  return points;
}

bool holds(const Box &box, const glm::dvec3 &p) {
  return glm::all(glm::lessThanEqual(box.low_m, p)) && glm::all(glm::lessThanEqual(p, box.high_m));
}

// Those that the lens and all diodes are outside of.
std::vector<std::uint32_t> bodies_from_outside(const CameraScene &camera, const Scene &scene,
                                               const std::vector<CameraIlluminator> &illuminators) {
  std::vector<std::uint32_t> bodies = convex_bodies(scene);
  bodies.resize(scene.shape_count(), no_id);
  std::map<std::uint32_t, Box> boxes;
  for (const auto *triangles : {&camera.triangles, &camera.hidden})
    for (const CameraTriangle &triangle : *triangles)
      if (const std::uint32_t body = bodies[triangle.id]; body != no_id)
        for (const glm::dvec3 &corner_m : triangle.corners_m)
          boxes[body].add(corner_m);
  std::set<std::uint32_t> entered;
  for (const auto &[body, box] : boxes) {
    bool inside = holds(box, glm::dvec3(0.0));
    for (const CameraIlluminator &illuminator : illuminators)
      for (const Diode &diode : illuminator.diodes)
        inside = inside || holds(box, diode.position_m);
    if (inside)
      entered.insert(body);
  }
  for (std::uint32_t &body : bodies)
    if (entered.contains(body))
      body = no_id;
  return bodies;
}

bool may_have_holes(const Scene &scene, std::uint32_t id) {
  const auto &paint = scene.surfaces[scene.surface_of(id)].paint;
  return id >= scene.triangles.size() || (paint && paint->alpha_cutoff > 0.0);
}

shader::Occluder occluder_of(const CameraTriangle &triangle, const Plane &plane, const Scene &scene,
                             std::uint32_t body) {
  const auto &[a, b, c] = triangle.corners_m;
  const DoublePair4 plane_pair(plane.normal, plane.offset_m), a_pair(a, 0.0), b_pair(b, 0.0), c_pair(c, 0.0);
  const auto turned = [](const glm::dvec3 &from, const glm::dvec3 &to) {
    return comes_before(to, from) ? 1u : 0u;
  };
  return {plane_pair.hi,
          plane_pair.lo,
          a_pair.hi,
          b_pair.hi,
          c_pair.hi,
          a_pair.lo,
          b_pair.lo,
          c_pair.lo,
          triangle.id,
          turned(a, b) | turned(b, c) << 1 | turned(c, a) << 2,
          may_have_holes(scene, triangle.id) ? 1u : 0u,
          body};
}

} // namespace

Occluders find_occluders(const CameraScene &camera, const Scene &scene,
                         const std::vector<CameraIlluminator> &illuminators) {
  const PointSet seen = seen_corners(camera), diodes = all_diodes(illuminators);
  Occluders occluders{{}, bodies_from_outside(camera, scene, illuminators)};
  const auto add = [&](const CameraTriangle &triangle) {
    const auto plane = front_plane(triangle.corners_m);
    if (!plane)
      return;
    const RoundedPlane rounded{*plane, camera.world_rounding_m};
    const Sides lit = diodes.sides(rounded);
    if (!lit.front && !lit.back)
      return;
    const Sides points = seen.sides(rounded);
    if ((lit.front && points.back) || (lit.back && points.front))
      occluders.shapes.push_back(occluder_of(triangle, *plane, scene, occluders.bodies[triangle.id]));
  };
  std::ranges::for_each(camera.triangles, add);
  std::ranges::for_each(camera.hidden, add);
  return occluders;
}

} // namespace pmdsim
