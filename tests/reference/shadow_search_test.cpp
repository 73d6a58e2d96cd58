// Shadows in scenes of many shapes, against a search over all triangles.

#include "engine/reference/light/light_paths.h"
#include "tests/reference/shadow_fixture.h"
#include "tests/support/random_scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;
using reference::CameraTriangle;
using reference::DiodeSet;
using reference::Frame;

namespace {

bool reaches(const Frame &frame, std::size_t sample, std::size_t words, std::size_t diode) {
  return (frame.sample_visibility[sample * words + diode / 32] >> diode % 32 & 1U) != 0;
}

using Real = long double;
using Vector = glm::vec<3, Real>;

// How far inside a triangle the segment passes, in shares of its edges and of itself: negative beside it.
// T. Moeller, B. Trumbore, "Fast, minimum storage ray/triangle intersection" (1997).
Real depth_inside(const CameraTriangle &triangle, const Vector &from, const Vector &to) {
  const Vector a(triangle.corners_m[0]), b(triangle.corners_m[1]), c(triangle.corners_m[2]);
  const Vector way = to - from, p = glm::cross(way, c - a), q = glm::cross(from - a, b - a);
  const Real determinant = glm::dot(b - a, p);
  const Real u = glm::dot(from - a, p) / determinant, v = glm::dot(way, q) / determinant,
             t = glm::dot(c - a, q) / determinant;
  return std::min({u, v, 1 - u - v, t, 1 - t});
}

Real deepest_inside(const std::vector<CameraTriangle> &triangles, std::uint32_t own_id,
                    const glm::dvec3 &point_m, const glm::dvec3 &diode_m) {
  Real deepest = -1;
  for (std::uint32_t id = 0; id < triangles.size(); ++id)
    if (id != own_id)
      deepest = std::max(deepest, depth_inside(triangles[id], Vector(point_m), Vector(diode_m)));
  return deepest;
}

struct BruteForce {
  int blocked = 0, free = 0, wrong = 0;
};

// Leaves out what passes within a billionth of a triangle's edge.
BruteForce compare_with_brute_force(const Scene &scene, const Sensor &sensor, const Illuminator &light) {
  const Frame frame = frame_of(scene, sensor, {light});
  const auto triangles = reference::triangles_in_camera(scene, sensor);
  const auto diodes = reference::diodes_in_camera(light, sensor);
  const std::size_t words = (diodes.size() + 31) / 32;
  BruteForce result;
  for (std::uint32_t sample = 0; sample < frame.sample_triangle_id.size(); ++sample) {
    const std::uint32_t id = frame.sample_triangle_id[sample];
    if (id == no_id)
      continue;
    const glm::dvec3 point_m = point_seen(sensor, frame, sample);
    const glm::dvec3 normal = front_towards_lens(triangles[id], point_m);
    for (std::size_t m = 0; m < diodes.size(); ++m) {
      const bool reached = reaches(frame, sample, words, m);
      if (glm::dot(normal, diodes[m].position_m - point_m) <= 0) {
        result.wrong += reached;
        continue;
      }
      const Real inside = deepest_inside(triangles, id, point_m, diodes[m].position_m);
      const bool blocked = inside > Real{1e-9}, free = inside < Real{-1e-9};
      result.blocked += blocked;
      result.free += free;
      result.wrong += (blocked && reached) || (free && !reached);
    }
  }
  return result;
}

} // namespace

TEST_CASE("random scenes are shadowed as a search over all triangles finds") {
  Random random(37);
  BruteForce sum;
  for (int i = 0; i < 12; ++i) {
    const Pose world_from_camera = random.pose(i % 2 ? 5 : 1000);
    const Scene scene = random_triangles(random, i < 6 ? 20 : 200, world_from_camera);
    const Sensor sensor = wide_sensor({20, 20}, 1, world_from_camera);
    // Some beside the lens, some among the triangles.
    std::vector<glm::dvec3> diodes_m;
    for (int m = 0; m < 40; ++m)
      diodes_m.push_back(random.in_box({-1, -1, -0.5}, {1, 1, m % 2 ? 2.5 : 0.1}));
    const auto [blocked, free, wrong] = compare_with_brute_force(scene, sensor, diodes_at(sensor, diodes_m));
    CHECK(wrong == 0);
    sum.blocked += blocked;
    sum.free += free;
  }
  CHECK(sum.blocked > 10000);
  CHECK(sum.free > 10000);
}

// Whose rounding in float is as large as the bars.
TEST_CASE("thin bars close to the diodes are not lost from points far away") {
  Random random(38);
  SceneBuilder builder;
  builder.add_wall({50000, {}, {-1e5, -1e5}, {1e5, 1e5}});
  for (int bar = 0; bar < 300; ++bar) {
    const double x_m = 0.05 + 0.001 * bar, width_m = random.uniform(1e-5, 6e-4);
    builder.add_wall({0.02, {}, {x_m, -0.3}, {x_m + width_m, 0.3}});
  }
  const Sensor sensor = wide_sensor({12, 12}, 1);
  std::vector<glm::dvec3> diodes_m;
  for (int m = 0; m < 60; ++m)
    diodes_m.push_back(random.in_box({0.05, -0.2, 0}, {0.35, 0.2, 0.01}));
  const auto [blocked, free, wrong] =
      compare_with_brute_force(builder.scene(), sensor, diodes_at(sensor, diodes_m));
  CHECK(wrong == 0);
  CHECK(blocked > 1000);
  CHECK(free > 1000);
}
