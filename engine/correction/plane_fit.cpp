#include "engine/correction/plane_fit.h"

#include <vector>

namespace pmdsim {
namespace {

glm::dvec3 within(const PixelFrame &frame, const glm::dvec3 &ray) {
  return {glm::dot(frame.along, ray), glm::dot(frame.across, ray), glm::dot(frame.down, ray)};
}

// Least squares of 1 / r over the points of a window.
class PlaneFit {
public:
  PlaneFit(const Neighbourhood &around, const Window &window) {
    around.visit(window, [&](int column, int row) { points_.push_back(around.point(column, row)); });
    is_possible_ = static_cast<int>(points_.size()) >= window.least_count() && invert();
  }

  // Nothing where the pixels lie in a line, or are too few.
  std::optional<FittedPlane> plane(bool common_normal) const {
    if (!is_possible_)
      return std::nullopt;
    constexpr int most_rounds = 30;
    constexpr double settled = 1e-11;
    FittedPlane plane{solve(points_.front().normal, false), 0.0, 0.0};
    for (int round = 0; common_normal && round < most_rounds; ++round) {
      const glm::dvec3 before = plane.normal();
      plane.g = solve(before, true);
      if (glm::distance(plane.normal(), before) < settled)
        break;
    }
    double squares = 0.0;
    for (const Point &point : points_) {
      const double off = residual_m(point, plane);
      squares += off * off;
    }
    plane.residual_m = std::sqrt(squares / static_cast<double>(points_.size() - 3));
    const double range_m = points_.front().range_m;
    plane.uncertainty_rad = plane.residual_m / (range_m * range_m * glm::length(plane.g)) *
                            std::sqrt(inverse_[1][1] + inverse_[2][2]);
    return plane;
  }

private:
  bool invert() {
    glm::dmat3 matrix(0.0);
    for (const Point &point : points_)
      matrix += glm::outerProduct(point.direction, point.direction);
    // Scaled, as a ray's parts across are small.
    const glm::dvec3 scale(1.0 / std::sqrt(matrix[0][0]), 1.0 / std::sqrt(matrix[1][1]),
                           1.0 / std::sqrt(matrix[2][2]));
    const glm::dmat3 scaling(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z);
    const glm::dmat3 scaled = scaling * matrix * scaling;
    if (!(glm::determinant(scaled) > 1e-9))
      return false;
    inverse_ = scaling * glm::inverse(scaled) * scaling;
    return true;
  }
  glm::dvec3 solve(const glm::dvec3 &normal, bool for_normal) const {
    glm::dvec3 right(0.0);
    for (const Point &point : points_)
      right += point.direction / (for_normal ? point.range_for_m(normal) : point.range_m);
    return inverse_ * right;
  }

  std::vector<Point> points_;
  glm::dmat3 inverse_{0.0};
  bool is_possible_ = false;
};

} // namespace

PixelFrame frame_about(const glm::dvec3 &ray) {
  const glm::dvec3 aside = std::abs(ray.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(aside, ray));
  return {ray, across, glm::cross(ray, across)};
}

glm::dvec3 Neighbourhood::direction(int column, int row) const {
  return within(frame_, image_.ray[index(column, row)]);
}

bool Neighbourhood::ends_at_border(int n) const {
  bool is_whole = true;
  for (int row = -n; row <= n; ++row)
    for (int column = -n; column <= n; ++column) {
      if (is_inside(column, row) && !has(column, row))
        return false;
      is_whole = is_whole && is_inside(column, row);
    }
  return !is_whole;
}

Point Neighbourhood::point(int column, int row) const {
  Point point{direction(column, row), range_m(column, row), glm::dvec3(0.0), glm::dvec3(0.0)};
  if (common_normal_) {
    point.normal = within(frame_, image_.normal[index(column, row)]);
    point.per_normal_m = within(frame_, image_.per_normal_m[index(column, row)]);
  }
  return point;
}

double Neighbourhood::gain() const {
  if (image_.per_normal_m.empty() || image_.ray.size() < 2)
    return 0.0;
  const bool along_row = image_.resolution.x > 1;
  const int step = (along_row ? at_.x : at_.y) > 0 ? -1 : 1;
  const glm::dvec3 &other = image_.ray[along_row ? index(step, 0) : index(0, step)];
  const double apart_m = range_m(0, 0) * glm::distance(image_.ray[index(0, 0)], other);
  return glm::length(image_.per_normal_m[index(0, 0)]) / apart_m;
}

double residual_m(const Point &point, const FittedPlane &plane) {
  const double range_m = point.range_for_m(plane.normal());
  return range_m * (range_m * glm::dot(plane.g, point.direction) - 1.0);
}

std::optional<FittedPlane> fitted_plane(const Neighbourhood &around, const Window &window) {
  return PlaneFit(around, window).plane(around.common_normal());
}

} // namespace pmdsim
