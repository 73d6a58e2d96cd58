#include "engine/correction/surface_fit.h"

#include "engine/correction/plane_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

// A window that fits so well, by the noise or a float's rounding, is not doubted.
constexpr double sure_noises = 1.5, rounding = 6e-8;
// How much better than the window about a pixel another one must fit: on a smooth, curved surface all fit
// alike, but only that one's normal is the pixel's own.
constexpr double better_beside = 4.0;
// A curved surface turns from the middle of a window beside a pixel to the pixel by so many times what its
// residuals say.
constexpr double bent_beside = 5.0;
// Beyond, the normal is worth nothing.
constexpr double no_plane_rad = 0.5;

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
  const PixelFrame &frame = around.frame();
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
  if (about && about->residual_m < sure_noises * std::fmax(around.noise_m(), rounding * around.range_m(0, 0)))
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
  SurfaceFit surface =
      best ? surface_of(around, *best, bent_beside * best_rad) : SurfaceFit{-around.frame().along};
  surface.one_sided = !best || !around.ends_at_border(n); // beyond the image nothing can be
  surface.off_m = best ? best->residual_m : 0.0;
  return surface;
}

// How normals turn from a pixel to the next, `step` values on; 0 where they are not those of pixels
// themselves.
glm::dvec3 turn(const std::vector<SurfaceFit> &fits, std::size_t pixel, std::size_t step, bool has_both) {
  if (!has_both || fits[pixel - step].one_sided || fits[pixel].one_sided || fits[pixel + step].one_sided)
    return glm::dvec3(0.0);
  return 0.5 * (fits[pixel + step].normal - fits[pixel - step].normal);
}

// The same of all neighbours, where a normal was found as if it did not turn.
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
        gains[pixel] = around.gain() > least_common_gain ? around.gain() : 0.0;
      } else {
        fits[pixel].normal = -image.ray[pixel];
      }
    }
  });
  std::vector<SurfaceFit> compared = fits;
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * image.resolution.x + column;
      SurfaceFit &fit = compared[pixel];
      fit.turn_columns = turn(fits, pixel, 1, column > 0 && column + 1 < image.resolution.x);
      fit.turn_rows = turn(fits, pixel, image.resolution.x, row > 0 && row + 1 < image.resolution.y);
      fit.off_m = std::max(fit.off_m, off_m(fits, image.resolution, {column, row}));
      fit.uncertainty_rad =
          std::max({fit.uncertainty_rad, disagreement_rad(fits, image.resolution, {column, row}),
                    gains[pixel] * turn_rad(fits, image.resolution, {column, row})});
    }
  });
  return compared;
}

} // namespace pmdsim
