#include "tests/comparison/shadow_clearance.h"

#include "engine/reference/view/surface_colours.h"
#include "tests/comparison/seen_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace pmdsim::test {

namespace {

struct Segment {
  glm::dvec3 from_m, to_m;

  glm::dvec3 at(double t) const { return from_m + t * (to_m - from_m); }
  double nearest_to(const glm::dvec3 &point_m) const {
    const glm::dvec3 along_m = to_m - from_m;
    const double square = glm::dot(along_m, along_m);
    return square > 0 ? std::clamp(glm::dot(point_m - from_m, along_m) / square, 0.0, 1.0) : 0.0;
  }
  double distance_m(const glm::dvec3 &point_m) const {
    return glm::distance(point_m, at(nearest_to(point_m)));
  }
};

// Where neither segment's nearest point is an end of it the distance is that of their lines, else that of
// some end to the other segment.
double distance_m(const Segment &a, const Segment &b) {
  const double ends_m =
      std::min({b.distance_m(a.from_m), b.distance_m(a.to_m), a.distance_m(b.from_m), a.distance_m(b.to_m)});
  const glm::dvec3 u = a.to_m - a.from_m, v = b.to_m - b.from_m, w = b.from_m - a.from_m;
  const glm::dvec3 across = glm::cross(u, v);
  const double square = glm::dot(across, across);
  if (square == 0)
    return ends_m;
  const double s = glm::dot(glm::cross(w, v), across) / square,
               t = glm::dot(glm::cross(w, u), across) / square;
  const bool within = s >= 0 && s <= 1 && t >= 0 && t <= 1;
  return within ? std::min(ends_m, std::abs(glm::dot(w, across)) / std::sqrt(square)) : ends_m;
}

// The distance to a circle has few minima along a line: one a step at most, which thirds narrow down.
double distance_to_rim_m(const Segment &segment, const reference::CameraDisc &disc) {
  const auto from_rim_m = [&](double t) {
    const glm::dvec3 off_m = segment.at(t) - disc.centre_m;
    const double height_m = glm::dot(off_m, disc.axis());
    const double radius_m = std::sqrt(std::max(0.0, glm::dot(off_m, off_m) - height_m * height_m));
    return std::hypot(radius_m - disc.radius_m, height_m);
  };
  constexpr int steps = 64;
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int k = 0; k < steps; ++k) {
    double lower = static_cast<double>(k) / steps, upper = static_cast<double>(k + 1) / steps;
    for (int third = 0; third < 50; ++third) {
      const double width = upper - lower, a = lower + width / 3, b = upper - width / 3;
      if (from_rim_m(a) < from_rim_m(b))
        upper = b;
      else
        lower = a;
    }
    nearest_m = std::min(nearest_m, from_rim_m(lower));
  }
  return nearest_m;
}

// How much each corner of a triangle counts at a point of its plane.
glm::dvec3 weights_at(const glm::dvec3 &point_m, const reference::CameraTriangle &triangle) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 normal = triangle.front();
  const double whole = glm::dot(normal, normal);
  const double of_b = glm::dot(normal, glm::cross(point_m - a, c - a)) / whole;
  const double of_c = glm::dot(normal, glm::cross(b - a, point_m - a)) / whole;
  return {1 - of_b - of_c, of_b, of_c};
}

bool inside(const glm::dvec3 &weights) { return glm::all(glm::greaterThanEqual(weights, glm::dvec3(0.0))); }

// Where the line meets the triangle's plane, between its ends.
std::optional<glm::dvec3> crossing_m(const Segment &segment, const reference::CameraTriangle &triangle) {
  const glm::dvec3 normal = triangle.front(), along_m = segment.to_m - segment.from_m;
  const double t = glm::dot(normal, triangle.corners_m[0] - segment.from_m) / glm::dot(normal, along_m);
  if (!(t >= 0 && t <= 1))
    return std::nullopt;
  return segment.at(t);
}

double distance_m(const glm::dvec3 &point_m, const reference::CameraTriangle &triangle) {
  const auto &[a, b, c] = triangle.corners_m;
  const glm::dvec3 normal = glm::normalize(triangle.front());
  const double height_m = glm::dot(normal, point_m - a);
  if (inside(weights_at(point_m - height_m * normal, triangle)))
    return std::abs(height_m);
  return std::min({Segment{a, b}.distance_m(point_m), Segment{b, c}.distance_m(point_m),
                   Segment{c, a}.distance_m(point_m)});
}

double distance_m(const glm::dvec3 &point_m, const reference::CameraDisc &disc) {
  const glm::dvec3 off_m = point_m - disc.centre_m;
  const double height_m = glm::dot(off_m, disc.axis());
  const double radius_m = std::sqrt(std::max(0.0, glm::dot(off_m, off_m) - height_m * height_m));
  return std::hypot(std::max(0.0, radius_m - disc.radius_m), height_m);
}

} // namespace

ShadowClearances::ShadowClearances(const Scene &scene, const Sensor &sensor,
                                   const std::vector<Illuminator> &illuminators)
    : scene_(scene), sensor_(sensor), lens_(sensor),
      triangles_(reference::triangles_in_camera(scene, sensor)),
      discs_(reference::discs_in_camera(scene, sensor)) {
  for (const Illuminator &illuminator : illuminators)
    for (const Diode &diode : reference::diodes_in_camera(illuminator, sensor))
      diodes_m_.push_back(diode.position_m);
}

ShadowClearance ShadowClearances::of(const glm::uvec2 &sample, std::uint32_t id, std::size_t diode) const {
  const glm::dvec3 point_m =
      plane_of(id, scene_, sensor_, triangles_).meeting_point_m(*lens_.sample_ray(sample));
  const glm::dvec3 &diode_m = diodes_m_.at(diode);
  ShadowClearance clearance{to_edges_m(point_m, diode_m),
                            std::min(to_shapes_m(point_m, id), to_shapes_m(diode_m, id))};
  if (mask_changes(point_m, diode_m, id))
    clearance.edge_m = 0.0;
  return clearance;
}

double ShadowClearances::to_edges_m(const glm::dvec3 &from_m, const glm::dvec3 &to_m) const {
  const Segment line{from_m, to_m};
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const reference::CameraTriangle &triangle : triangles_)
    for (std::size_t k = 0; k < 3; ++k)
      nearest_m = std::min(nearest_m,
                           distance_m(line, Segment{triangle.corners_m[k], triangle.corners_m[(k + 1) % 3]}));
  for (const reference::CameraDisc &disc : discs_)
    nearest_m = std::min(nearest_m, distance_to_rim_m(line, disc));
  return nearest_m;
}

double ShadowClearances::to_shapes_m(const glm::dvec3 &point_m, std::uint32_t left_out) const {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (std::size_t id = 0; id < triangles_.size(); ++id)
    if (id != left_out)
      nearest_m = std::min(nearest_m, distance_m(point_m, triangles_[id]));
  for (std::size_t i = 0; i < discs_.size(); ++i)
    if (triangles_.size() + i != left_out)
      nearest_m = std::min(nearest_m, distance_m(point_m, discs_[i]));
  return nearest_m;
}

// Asks the masks that the line passes on sixteen lines around it as well.
bool ShadowClearances::mask_changes(const glm::dvec3 &from_m, const glm::dvec3 &to_m,
                                    std::uint32_t left_out) const {
  const glm::dvec3 along = glm::normalize(to_m - from_m);
  const glm::dvec3 aside = std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(along, aside)), v = glm::cross(along, u);
  for (std::uint32_t id = 0; id < triangles_.size(); ++id) {
    if (!triangles_[id].cutouts || id == left_out)
      continue;
    bool there = false, missing = false;
    for (int k = 0; k < 16; ++k) {
      const double angle = 2 * std::numbers::pi * k / 16;
      const glm::dvec3 shift_m = rounding_distance_m * (std::cos(angle) * u + std::sin(angle) * v);
      const auto point_m = crossing_m({from_m + shift_m, to_m + shift_m}, triangles_[id]);
      if (!point_m || !inside(weights_at(*point_m, triangles_[id])))
        continue;
      const bool is = reference::is_there(scene_, id, weights_at(*point_m, triangles_[id]));
      (is ? there : missing) = true;
    }
    if (there && missing)
      return true;
  }
  return false;
}

} // namespace pmdsim::test
