#include "host/input/setup/plausibility.h"

#include <algorithm>
#include <array>
#include <limits>

namespace pmdsim {
namespace {

constexpr std::size_t most_pairs = std::size_t{1} << 22; // of points and bodies: beyond that nothing is told

struct Box {
  glm::dvec3 min_m{std::numeric_limits<double>::infinity()};
  glm::dvec3 max_m{-std::numeric_limits<double>::infinity()};

  void add(const glm::dvec3 &point_m) {
    min_m = glm::min(min_m, point_m);
    max_m = glm::max(max_m, point_m);
  }
  bool contains(const glm::dvec3 &p) const {
    return glm::all(glm::greaterThan(p, min_m)) && glm::all(glm::lessThan(p, max_m));
  }
  bool contains_any(const std::vector<glm::dvec3> &points_m) const {
    return std::ranges::any_of(points_m, [&](const glm::dvec3 &point) { return contains(point); });
  }
  double longest_m() const {
    const glm::dvec3 size = max_m - min_m;
    return std::max({size.x, size.y, size.z});
  }
};

struct Body {
  Box box;
  bool shows_both_sides = false, has_holes = false;
};

std::vector<Body> bodies_of(const Scene &scene) {
  std::vector<Body> bodies(scene.objects.size());
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const Triangle &triangle = scene.triangles[i];
    Body &body = bodies[triangle.object];
    for (const std::uint32_t vertex : triangle.vertices)
      body.box.add(scene.positions_m[vertex]);
    body.shows_both_sides = body.shows_both_sides || scene.surfaces[triangle.surface].double_sided;
    body.has_holes = body.has_holes || scene.is_masked(i);
  }
  return bodies;
}

// Directions in which no edge of what people model lies.
const std::array<glm::dvec3, 3> line_directions{glm::normalize(glm::dvec3(0.5377, 0.8339, 0.1251)),
                                                glm::normalize(glm::dvec3(-0.7263, 0.2137, 0.6531)),
                                                glm::normalize(glm::dvec3(0.2891, -0.4517, -0.8441))};

// Parallel lines through points, looked at along their direction: a triangle that a line crosses has the
// line's point within its outline.
class ParallelLines {
public:
  ParallelLines(const glm::dvec3 &direction, const std::vector<glm::dvec3> &points_m,
                const std::vector<std::size_t> &asked)
      : z_(direction), x_(glm::normalize(glm::cross(direction, glm::dvec3(0.0, 0.0, 1.0)))),
        y_(glm::cross(z_, x_)), leaves_(asked.size()) {
    for (const std::size_t point : asked) {
      seen_.push_back(along(points_m[point]));
      box_.add(seen_.back());
    }
  }

  void cross(const std::array<glm::dvec3, 3> &corners_m) {
    const std::array<glm::dvec3, 3> t{along(corners_m[0]), along(corners_m[1]), along(corners_m[2])};
    for (glm::length_t axis = 0; axis < 2; ++axis)
      if (std::min({t[0][axis], t[1][axis], t[2][axis]}) > box_.max_m[axis] ||
          std::max({t[0][axis], t[1][axis], t[2][axis]}) < box_.min_m[axis])
        return;
    for (std::size_t i = 0; i < seen_.size(); ++i)
      add_crossing(t, seen_[i], leaves_[i]);
  }

  // Whether the i-th that was asked leaves by more surfaces than it enters, ahead and behind.
  bool is_inside(std::size_t i) const { return leaves_[i].ahead > 0 && leaves_[i].behind > 0; }

private:
  glm::dvec3 along(const glm::dvec3 &p) const { return {glm::dot(p, x_), glm::dot(p, y_), glm::dot(p, z_)}; }

  static double area(const glm::dvec3 &a, const glm::dvec3 &b, const glm::dvec3 &c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  // Surfaces that are left less those that are entered, on the way ahead and on the way back.
  struct Leaves {
    int ahead = 0, behind = 0;
  };

  // The areas of neighbours' common edges differ in sign alone, so that a ray is in one of them.
  static void add_crossing(const std::array<glm::dvec3, 3> &t, const glm::dvec3 &p, Leaves &leaves) {
    const double a = area(t[1], t[2], p), b = area(t[2], t[0], p), c = area(t[0], t[1], p);
    const bool is_front = a > 0.0 && b > 0.0 && c > 0.0, is_back = a < 0.0 && b < 0.0 && c < 0.0;
    if (!is_front && !is_back)
      return;
    const double depth = (a * t[0].z + b * t[1].z + c * t[2].z) / (a + b + c);
    if (depth > p.z)
      leaves.ahead += is_front ? 1 : -1;
    else
      leaves.behind += is_front ? -1 : 1;
  }

  glm::dvec3 z_, x_, y_;
  std::vector<glm::dvec3> seen_;
  Box box_;
  std::vector<Leaves> leaves_;
};

bool may_close(const Body &body, double largest_m) {
  return !body.has_holes && (!body.shows_both_sides || body.box.longest_m() <= largest_m);
}

// Triangles of each of some objects.
using Triangles = std::vector<std::vector<std::uint32_t>>;

Triangles triangles_of(const Scene &scene, const std::vector<std::uint32_t> &objects) {
  std::vector<std::size_t> place(scene.objects.size(), objects.size());
  for (std::size_t k = 0; k < objects.size(); ++k)
    place[objects[k]] = k;
  Triangles triangles(objects.size());
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i)
    if (const std::size_t k = place[scene.triangles[i].object]; k < objects.size())
      triangles[k].push_back(i);
  return triangles;
}

// Those of the points `asked` that are inside by all directions; of a body that does not close they disagree.
std::vector<std::size_t> inside(const Scene &scene, const std::vector<std::uint32_t> &triangles,
                                const std::vector<glm::dvec3> &points_m, std::vector<std::size_t> asked) {
  for (const glm::dvec3 &direction : line_directions) {
    if (asked.empty())
      break;
    ParallelLines lines(direction, points_m, asked);
    for (const std::uint32_t triangle : triangles) {
      const auto &[a, b, c] = scene.triangles[triangle].vertices;
      lines.cross({scene.positions_m[a], scene.positions_m[b], scene.positions_m[c]});
    }
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < asked.size(); ++i)
      if (lines.is_inside(i))
        left.push_back(asked[i]);
    asked = std::move(left);
  }
  return asked;
}

} // namespace

std::vector<std::uint32_t> bodies_around(const Scene &scene, const std::vector<glm::dvec3> &points_m,
                                         double largest_m) {
  std::vector<std::uint32_t> around(points_m.size(), no_id);
  const std::vector<Body> bodies = bodies_of(scene);
  std::vector<std::uint32_t> candidates;
  for (std::uint32_t object = 0; object < bodies.size(); ++object)
    if (const Body &body = bodies[object]; may_close(body, largest_m) && body.box.contains_any(points_m))
      candidates.push_back(object);
  if (candidates.empty() || candidates.size() * points_m.size() > most_pairs)
    return around;
  const Triangles triangles = triangles_of(scene, candidates);
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const Box &box = bodies[candidates[k]].box;
    std::vector<std::size_t> asked;
    for (std::size_t i = 0; i < points_m.size(); ++i)
      if (box.contains(points_m[i]))
        asked.push_back(i);
    for (const std::size_t i : inside(scene, triangles[k], points_m, std::move(asked)))
      around[i] = candidates[k];
  }
  return around;
}

} // namespace pmdsim
