#include "engine/correction/surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

// A window that fits so well, by the noise, is not doubted.
constexpr double sure_noises = 1.5, sure_rad = 2e-5;
// Where ranges depend more on their normals, for each distance of neighbouring points, windows have a normal
// in common.
constexpr double least_common_gain = 0.35;
// How much better than the window about a pixel another one must fit: on a smooth, curved surface all fit
// alike, but only that one's normal is the pixel's own.
constexpr double better_beside = 4.0;
// Beyond, the normal is worth nothing.
constexpr double no_plane_rad = 0.5;

struct Window {
  int first_column, last_column, first_row, last_row; // from the pixel
  // A triangle, half of the square: only pixels so many steps from the pixel, columns and rows together.
  int most_steps = std::numeric_limits<int>::max();

  bool has(int column, int row) const { return std::abs(column) + std::abs(row) <= most_steps; }
  // That it takes: a plane through two rows or two columns alone fits whatever lies there.
  int least_count() const {
    const int pixels = (last_column - first_column + 1) * (last_row - first_row + 1);
    return most_steps == std::numeric_limits<int>::max() ? pixels * 3 / 4 + 1 : pixels * 2 / 3;
  }
};

// A plane's g in the frame of the pixel's ray, and how far it may be off.
struct Plane {
  glm::dvec3 g;
  double uncertainty_rad, residual_m;

  glm::dvec3 normal() const { return -glm::normalize(g); }
};

// A pixel in that frame.
struct Point {
  glm::dvec3 direction;
  double range_m;
  glm::dvec3 normal, per_normal_m;

  double range_for_m(const glm::dvec3 &of_plane) const {
    return range_m + glm::dot(per_normal_m, of_plane - normal);
  }
};

struct Frame {
  glm::dvec3 along, across, down;
};

Frame frame_about(const glm::dvec3 &ray) {
  const glm::dvec3 aside = std::abs(ray.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 across = glm::normalize(glm::cross(aside, ray));
  return {ray, across, glm::cross(ray, across)};
}

glm::dvec3 within(const Frame &frame, const glm::dvec3 &ray) {
  return {glm::dot(frame.along, ray), glm::dot(frame.across, ray), glm::dot(frame.down, ray)};
}

// The pixels about one pixel.
class Neighbourhood {
public:
  Neighbourhood(const RangeImage &image, glm::ivec2 at)
      : image_(image), at_(at), frame_(frame_about(image.ray[index(0, 0)])) {
    common_normal_ = gain() > least_common_gain;
  }

  const Frame &frame() const { return frame_; }
  bool has(int column, int row) const {
    const glm::ivec2 p = at_ + glm::ivec2(column, row);
    return p.x >= 0 && p.y >= 0 && p.x < static_cast<int>(image_.resolution.x) &&
           p.y < static_cast<int>(image_.resolution.y) && std::isfinite(image_.range_m[index(column, row)]);
  }
  bool is_at_border(int n) const {
    const glm::ivec2 end = at_ + n;
    return at_.x < n || at_.y < n || end.x >= static_cast<int>(image_.resolution.x) ||
           end.y >= static_cast<int>(image_.resolution.y);
  }
  double noise_m() const { return image_.noise_m; }
  double range_m(int column, int row) const { return image_.range_m[index(column, row)]; }
  glm::dvec3 direction(int column, int row) const { return within(frame_, image_.ray[index(column, row)]); }
  Point point(int column, int row) const {
    Point point{direction(column, row), range_m(column, row), {}, glm::dvec3(0.0)};
    if (common_normal_) {
      point.normal = within(frame_, image_.normal[index(column, row)]);
      point.per_normal_m = within(frame_, image_.per_normal_m[index(column, row)]);
    }
    return point;
  }
  bool common_normal() const { return common_normal_; }
  // How far the pixel moves by its normal, for each radian, over the distance of neighbouring points.
  double gain() const {
    if (image_.per_normal_m.empty())
      return 0.0;
    const int column = at_.x > 0 ? -1 : 1;
    const double apart_m =
        range_m(0, 0) * glm::distance(image_.ray[index(0, 0)], image_.ray[index(column, 0)]);
    return glm::length(image_.per_normal_m[index(0, 0)]) / apart_m;
  }

  template <class Visit>
  void visit(const Window &window, Visit visit) const {
    for (int row = window.first_row; row <= window.last_row; ++row)
      for (int column = window.first_column; column <= window.last_column; ++column)
        if (window.has(column, row) && has(column, row))
          visit(column, row);
  }

private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(at_.y + row) * image_.resolution.x +
           static_cast<std::size_t>(at_.x + column);
  }

  const RangeImage &image_;
  glm::ivec2 at_;
  Frame frame_;
  bool common_normal_ = false;
};

// Range minus that of the plane, to first order.
double residual_m(const Point &point, const Plane &plane) {
  const double range_m = point.range_for_m(plane.normal());
  return range_m * (range_m * glm::dot(plane.g, point.direction) - 1.0);
}

// Least squares of 1 / r over the points of a window.
class PlaneFit {
public:
  PlaneFit(const Neighbourhood &around, const Window &window) {
    around.visit(window, [&](int column, int row) { points_.push_back(around.point(column, row)); });
    is_possible_ = static_cast<int>(points_.size()) >= window.least_count() && invert();
  }

  // Nothing where the pixels lie in a line, or are too few.
  std::optional<Plane> plane(bool common_normal) const {
    if (!is_possible_)
      return std::nullopt;
    constexpr int most_rounds = 30;
    constexpr double settled = 1e-11;
    Plane plane{solve(points_.front().normal, false), 0.0, 0.0};
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

std::optional<Plane> fitted_plane(const Neighbourhood &around, const Window &window) {
  return PlaneFit(around, window).plane(around.common_normal());
}

// How far a normal may be off because surfaces are not planes: by the part of the residuals that is odd about
// the pixel, and by what the windows on opposite sides have beside their mean.
double smooth_uncertainty_rad(const Neighbourhood &around, int n, const Plane &plane,
                              const std::array<std::optional<Plane>, 4> &beside) {
  double squares = 0.0, offsets = 0.0;
  int pairs = 0;
  around.visit({-n, n, -n, 0}, [&](int column, int row) {
    if ((row == 0 && column >= 0) || !around.has(-column, -row))
      return;
    const double odd =
        0.5 * (residual_m(around.point(column, row), plane) - residual_m(around.point(-column, -row), plane));
    squares += odd * odd;
    const glm::dvec3 off =
        around.range_m(column, row) * (around.direction(column, row) - glm::dvec3(1, 0, 0));
    offsets += off.y * off.y + off.z * off.z;
    ++pairs;
  });
  double uncertainty_rad = pairs > 2 ? std::sqrt(2.0 * squares / (pairs - 2) / offsets) : 1.0;
  for (const std::size_t side : {std::size_t{0}, std::size_t{2}})
    if (beside[side] && beside[side + 1])
      uncertainty_rad =
          std::max(uncertainty_rad, glm::length(0.5 * (beside[side]->g + beside[side + 1]->g) - plane.g) /
                                        glm::length(plane.g));
  return uncertainty_rad;
}

glm::dvec2 bend_m(const Neighbourhood &around, const Plane &plane) {
  const auto second = [&](int column, int row) {
    if (!around.has(column, row) || !around.has(-column, -row))
      return 0.0;
    return residual_m(around.point(column, row), plane) + residual_m(around.point(-column, -row), plane) -
           2.0 * residual_m(around.point(0, 0), plane);
  };
  return {second(1, 0), second(0, 1)};
}

SurfaceFit surface_of(const Neighbourhood &around, const Plane &plane, double uncertainty_rad) {
  const Frame &frame = around.frame();
  if (uncertainty_rad > no_plane_rad || !(plane.g.x > 0.0))
    return {-frame.along};
  const glm::dvec3 g = plane.g.x * frame.along + plane.g.y * frame.across + plane.g.z * frame.down;
  return {-glm::normalize(g), uncertainty_rad};
}

SurfaceFit surface_about(const Neighbourhood &around, const Plane &plane, double uncertainty_rad) {
  SurfaceFit surface = surface_of(around, plane, uncertainty_rad);
  surface.one_sided = false;
  surface.bend_m = bend_m(around, plane);
  return surface;
}

SurfaceFit fit_surface(const Neighbourhood &around, int n) {
  const std::optional<Plane> about = fitted_plane(around, {-n, n, -n, n});
  if (about && (about->residual_m < sure_noises * around.noise_m() || about->uncertainty_rad < sure_rad))
    return surface_about(around, *about, about->uncertainty_rad);
  const std::array<std::optional<Plane>, 4> beside{
      fitted_plane(around, {-2 * n, 0, -n, n}), fitted_plane(around, {0, 2 * n, -n, n}),
      fitted_plane(around, {-n, n, -2 * n, 0}), fitted_plane(around, {-n, n, 0, 2 * n})};
  std::optional<Plane> best;
  double best_rad = about ? about->uncertainty_rad / better_beside : 1.0;
  const auto offer = [&](const std::optional<Plane> &plane) {
    if (plane && plane->uncertainty_rad < best_rad) {
      best = plane;
      best_rad = plane->uncertainty_rad;
    }
  };
  std::ranges::for_each(beside, offer);
  for (const int left : {-2 * n, 0})
    for (const int up : {-2 * n, 0}) {
      offer(fitted_plane(around, {left, left + 2 * n, up, up + 2 * n}));
      offer(fitted_plane(around, {left, left + 2 * n, up, up + 2 * n, 2 * n}));
    }
  if (!best && about)
    return surface_about(around, *about, smooth_uncertainty_rad(around, n, *about, beside));
  SurfaceFit surface = best ? surface_of(around, *best, best_rad) : SurfaceFit{-around.frame().along};
  surface.one_sided = !best || !around.is_at_border(n); // beyond the image nothing can be
  surface.off_m = best ? best->residual_m : 0.0;
  return surface;
}

// By how much normals turn from a pixel to the next, where they are found as if they did not.
double turn_rad(const std::vector<SurfaceFit> &fits, const glm::uvec2 &resolution, glm::uvec2 at) {
  const std::size_t pixel = std::size_t{at.y} * resolution.x + at.x;
  const auto between = [&](bool has_before, bool has_after, std::size_t step) {
    const std::size_t before = has_before ? pixel - step : pixel, after = has_after ? pixel + step : pixel;
    return glm::distance(fits[before].normal, fits[after].normal) / (has_before && has_after ? 2.0 : 1.0);
  };
  const double turn = std::max(between(at.x > 0, at.x + 1 < resolution.x, 1),
                               between(at.y > 0, at.y + 1 < resolution.y, resolution.x));
  constexpr double least_uncertainties = 4.0; // noise turns them, too
  return std::max(turn - least_uncertainties * fits[pixel].uncertainty_rad, 0.0);
}

// A pixel that alone lies off makes the bend three times as different from that of the neighbours.
double off_m(const std::vector<SurfaceFit> &fits, const glm::uvec2 &resolution, glm::uvec2 at) {
  const std::size_t pixel = std::size_t{at.y} * resolution.x + at.x;
  glm::dvec2 difference(0.0);
  if (at.x > 0 && at.x + 1 < resolution.x)
    difference.x = fits[pixel].bend_m.x - 0.5 * (fits[pixel - 1].bend_m.x + fits[pixel + 1].bend_m.x);
  if (at.y > 0 && at.y + 1 < resolution.y)
    difference.y = fits[pixel].bend_m.y -
                   0.5 * (fits[pixel - resolution.x].bend_m.y + fits[pixel + resolution.x].bend_m.y);
  return std::max(std::abs(difference.x), std::abs(difference.y)) / 3.0;
}

// How far a normal is from what the four neighbours say of it: the nearest of theirs, on a flat facet, or the
// means of opposite ones, on a curved surface. A plane that fits by chance has no such neighbours.
double disagreement_rad(const std::vector<SurfaceFit> &fits, const glm::uvec2 &resolution, glm::uvec2 at) {
  const std::size_t pixel = std::size_t{at.y} * resolution.x + at.x;
  const glm::dvec3 &own = fits[pixel].normal;
  double nearest = 2.0, of_means = 0.0;
  const auto compare = [&](bool has_before, bool has_after, std::size_t step) {
    if (has_before)
      nearest = std::min(nearest, glm::distance(fits[pixel - step].normal, own));
    if (has_after)
      nearest = std::min(nearest, glm::distance(fits[pixel + step].normal, own));
    of_means =
        has_before && has_after
            ? std::max(of_means,
                       glm::distance(0.5 * (fits[pixel - step].normal + fits[pixel + step].normal), own))
            : 2.0;
  };
  compare(at.x > 0, at.x + 1 < resolution.x, 1);
  compare(at.y > 0, at.y + 1 < resolution.y, resolution.x);
  return std::min(nearest, of_means);
}

// The value that so many of all do not exceed.
double quantile(std::vector<double> values, double share) {
  if (values.empty())
    return not_known;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

// What `value_of` says of the pixels that have all eight neighbours.
template <class ValueOf>
std::vector<double> inside(const RangeImage &image, ValueOf value_of) {
  std::vector<double> values;
  for (int row = 1; row + 1 < static_cast<int>(image.resolution.y); ++row)
    for (int column = 1; column + 1 < static_cast<int>(image.resolution.x); ++column) {
      if (!std::isfinite(image.range_m[static_cast<std::size_t>(row) * image.resolution.x +
                                       static_cast<std::size_t>(column)]))
        continue;
      const Neighbourhood around(image, {column, row});
      int count = 0;
      around.visit({-1, 1, -1, 1}, [&](int, int) { ++count; });
      if (count == 9)
        values.push_back(value_of(around));
    }
  return values;
}

} // namespace

std::vector<SurfaceFit> fit_surfaces(const RangeImage &image, std::uint32_t n) {
  std::vector<SurfaceFit> fits(image.range_m.size());
  std::vector<double> gains(fits.size(), 0.0); // where windows have a normal in common
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * image.resolution.x + column;
      if (std::isfinite(image.range_m[pixel])) {
        const Neighbourhood around(image, {column, row});
        fits[pixel] = fit_surface(around, static_cast<int>(n));
        gains[pixel] = around.common_normal() ? around.gain() : 0.0;
      } else {
        fits[pixel].normal = -image.ray[pixel];
      }
    }
  });
  std::vector<SurfaceFit> compared = fits;
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * image.resolution.x + column;
      compared[pixel].off_m = std::max(fits[pixel].off_m, off_m(fits, image.resolution, {column, row}));
      compared[pixel].uncertainty_rad =
          std::max({fits[pixel].uncertainty_rad, disagreement_rad(fits, image.resolution, {column, row}),
                    gains[pixel] * turn_rad(fits, image.resolution, {column, row})});
    }
  });
  return compared;
}

double noise_of(const RangeImage &image) {
  const auto odd_parts = inside(image, [](const Neighbourhood &around) {
    const std::optional<Plane> plane = fitted_plane(around, {-1, 1, -1, 1});
    if (!plane)
      return std::numeric_limits<double>::max();
    double squares = 0.0;
    for (const auto &[column, row] :
         {std::pair(-1, -1), std::pair(0, -1), std::pair(1, -1), std::pair(-1, 0)}) {
      const double odd = 0.5 * (residual_m(around.point(column, row), *plane) -
                                residual_m(around.point(-column, -row), *plane));
      squares += odd * odd;
    }
    return squares; // of two degrees of freedom, each with half of the variance of a range
  });
  constexpr double share = 0.2; // of an exponential distribution
  return std::sqrt(quantile(odd_parts, share) / -std::log(1.0 - share));
}

double spacing_of(const RangeImage &image) {
  const auto spacings_m = inside(image, [](const Neighbourhood &around) {
    const glm::dvec3 across = 0.5 * (around.direction(1, 0) - around.direction(-1, 0)),
                     down = 0.5 * (around.direction(0, 1) - around.direction(0, -1));
    return around.range_m(0, 0) * std::sqrt(glm::length(glm::cross(across, down)));
  });
  return quantile(spacings_m, 0.5);
}

std::uint32_t fit_pixels_for(double noise_m, double spacing_m) {
  constexpr double wanted_rad = 2e-2;
  constexpr std::uint32_t most = 8;
  std::uint32_t n = 1;
  const auto uncertainty_rad = [&] {
    const double side = 2.0 * n + 1.0; // the sum of squares of either offset is side^2 n (n + 1) / 3
    return noise_m / spacing_m * std::sqrt(2.0 * 3.0 / (side * side * n * (n + 1.0)));
  };
  while (n < most && uncertainty_rad() > wanted_rad)
    ++n;
  return n;
}

} // namespace pmdsim
