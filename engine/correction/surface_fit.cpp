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

// A window that fits so well is not doubted.
constexpr double sure_rad = 5e-5;
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
  double uncertainty_rad;
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
      : image_(image), at_(at), frame_(frame_about(image.ray[index(0, 0)])) {}

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
  double range_m(int column, int row) const { return image_.range_m[index(column, row)]; }
  glm::dvec3 direction(int column, int row) const { return within(frame_, image_.ray[index(column, row)]); }

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
};

// Range minus that of the plane, to first order.
double residual_m(const Neighbourhood &around, const glm::dvec3 &g, int column, int row) {
  const double range_m = around.range_m(column, row);
  return range_m * (range_m * glm::dot(g, around.direction(column, row)) - 1.0);
}

// Least squares of 1 / r. Nothing where the pixels lie in a line, or are too few.
std::optional<Plane> fitted_plane(const Neighbourhood &around, const Window &window) {
  glm::dmat3 matrix(0.0);
  glm::dvec3 right(0.0);
  int count = 0;
  around.visit(window, [&](int column, int row) {
    const glm::dvec3 a = around.direction(column, row);
    matrix += glm::outerProduct(a, a);
    right += a / around.range_m(column, row);
    ++count;
  });
  if (count < window.least_count())
    return std::nullopt;
  // Scaled, as a ray's parts across are small.
  const glm::dvec3 scale(1.0 / std::sqrt(matrix[0][0]), 1.0 / std::sqrt(matrix[1][1]),
                         1.0 / std::sqrt(matrix[2][2]));
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      matrix[i][k] *= scale[i] * scale[k];
  const double determinant = glm::determinant(matrix);
  if (!(determinant > 1e-9))
    return std::nullopt;
  const glm::dmat3 inverse = glm::inverse(matrix);
  const glm::dvec3 g = scale * (inverse * (scale * right));
  double squares = 0.0;
  around.visit(window, [&](int column, int row) {
    const double off = glm::dot(g, around.direction(column, row)) - 1.0 / around.range_m(column, row);
    squares += off * off;
  });
  const double variance =
      squares / (count - 3) * (scale.y * scale.y * inverse[1][1] + scale.z * scale.z * inverse[2][2]);
  return Plane{g, std::sqrt(variance) / glm::length(g)};
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
        0.5 * (residual_m(around, plane.g, column, row) - residual_m(around, plane.g, -column, -row));
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
    return residual_m(around, plane.g, column, row) + residual_m(around, plane.g, -column, -row) -
           2.0 * residual_m(around, plane.g, 0, 0);
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
  if (about && about->uncertainty_rad < sure_rad)
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
  surface.one_sided = !around.is_at_border(n); // beyond the image nothing can be
  return surface;
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

double median_of(std::vector<double> values) {
  if (values.empty())
    return not_known;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What `value_of` says of the pixels that have all eight neighbours.
template <class ValueOf>
double median_inside(const RangeImage &image, ValueOf value_of) {
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
  return median_of(std::move(values));
}

} // namespace

std::vector<SurfaceFit> fit_surfaces(const RangeImage &image, std::uint32_t n) {
  std::vector<SurfaceFit> fits(image.range_m.size());
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * image.resolution.x + column;
      if (std::isfinite(image.range_m[pixel]))
        fits[pixel] = fit_surface(Neighbourhood(image, {column, row}), static_cast<int>(n));
      else
        fits[pixel].normal = -image.ray[pixel];
    }
  });
  std::vector<SurfaceFit> compared = fits;
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      SurfaceFit &fit = compared[std::size_t{row} * image.resolution.x + column];
      fit.uncertainty_rad =
          std::max(fit.uncertainty_rad, disagreement_rad(fits, image.resolution, {column, row}));
    }
  });
  return compared;
}

double noise_of(const RangeImage &image) {
  return median_inside(image, [](const Neighbourhood &around) {
    const std::optional<Plane> plane = fitted_plane(around, {-1, 1, -1, 1});
    if (!plane)
      return not_known;
    double squares = 0.0;
    for (const auto &[column, row] :
         {std::pair(-1, -1), std::pair(0, -1), std::pair(1, -1), std::pair(-1, 0)}) {
      const double odd =
          0.5 * (residual_m(around, plane->g, column, row) - residual_m(around, plane->g, -column, -row));
      squares += odd * odd;
    }
    return std::sqrt(squares); // two of the four pairs' odd parts are the plane's; each has half the variance
  });
}

double spacing_of(const RangeImage &image) {
  return median_inside(image, [](const Neighbourhood &around) {
    const glm::dvec3 across = 0.5 * (around.direction(1, 0) - around.direction(-1, 0)),
                     down = 0.5 * (around.direction(0, 1) - around.direction(0, -1));
    return around.range_m(0, 0) * std::sqrt(glm::length(glm::cross(across, down)));
  });
}

std::uint32_t fit_pixels_for(double noise_m, double spacing_m) {
  constexpr double wanted_rad = 5e-3;
  constexpr std::uint32_t most = 16;
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
