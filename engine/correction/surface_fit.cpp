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

// The part of a window's residuals that is odd about the pixel: noise, and what tells that the surface is no
// plane. Not the part that a bend leaves, which is even.
struct OddPart {
  double deviation_m = 0.0; // of single ranges
  double offsets = 0.0;     // the sum of the squares of how far pixels lie from the middle, m^2
  bool is_known = false;
};
OddPart odd_part(const Neighbourhood &around, int n, const FittedPlane &plane) {
  double squares = 0.0;
  OddPart part;
  int pairs = 0;
  around.visit({-n, n, -n, 0}, [&](int column, int row) {
    if ((row == 0 && column >= 0) || !around.has(-column, -row))
      return;
    const double odd =
        0.5 * (residual_m(around.point(column, row), plane) - residual_m(around.point(-column, -row), plane));
    squares += odd * odd;
    const glm::dvec3 off =
        around.range_m(column, row) * (around.direction(column, row) - glm::dvec3(1, 0, 0));
    part.offsets += off.y * off.y + off.z * off.z;
    ++pairs;
  });
  part.is_known = pairs > 2;
  part.deviation_m = part.is_known ? std::sqrt(2.0 * squares / (pairs - 2)) : 0.0;
  return part;
}

// How far a normal may be off because surfaces are not planes: by the odd part of the residuals, and by what
// the windows on opposite sides have beside their mean.
double smooth_uncertainty_rad(const OddPart &odd, const FittedPlane &plane,
                              const std::array<std::optional<FittedPlane>, 4> &beside) {
  double uncertainty_rad = odd.is_known ? odd.deviation_m / std::sqrt(odd.offsets) : 1.0;
  for (const std::size_t side : {std::size_t{0}, std::size_t{2}})
    if (beside[side] && beside[side + 1])
      uncertainty_rad =
          std::max(uncertainty_rad, glm::length(0.5 * (beside[side]->g + beside[side + 1]->g) - plane.g) /
                                        glm::length(plane.g));
  return uncertainty_rad;
}

// What noise alone may make of a value, by so many of its standard deviations, is taken off: what is left of
// a value that is clear is the value.
double beyond_noise(double size, double deviation) {
  constexpr double noises = 3.0;
  const double noise = noises * deviation;
  return size > noise ? std::sqrt(size * size - noise * noise) : 0.0;
}

// What is left of a vector, as beyond_noise().
template <class Vector>
Vector beyond_noise(const Vector &value, double deviation) {
  const double size = glm::length(value);
  return size > 0.0 ? value * (beyond_noise(size, deviation) / size) : value;
}

// The second difference of range along `step`, of the parabola through the pixels up to n to each side, and
// its standard deviation for each of a range. Least squares of the part of the residuals that is even.
struct SecondDifference {
  double value_m = 0.0, deviation = 0.0;
};
SecondDifference second_difference(const Neighbourhood &around, const FittedPlane &plane, glm::ivec2 step,
                                   int n) {
  // A range's weight, its square offset and its residual, in sums of even pairs and the middle.
  double weight = 1.0, squares = 0.0, fourths = 0.0, along_squares = 0.0;
  const double middle = residual_m(around.point(0, 0), plane);
  double sum = middle;
  for (int k = 1; k <= n; ++k) {
    const glm::ivec2 off = k * step;
    if (!around.has(off.x, off.y) || !around.has(-off.x, -off.y))
      continue;
    const double pair =
        residual_m(around.point(off.x, off.y), plane) + residual_m(around.point(-off.x, -off.y), plane);
    const double square = double(k) * k;
    weight += 2.0;
    squares += 2.0 * square;
    fourths += 2.0 * square * square;
    sum += pair;
    along_squares += square * pair;
  }
  if (squares == 0.0)
    return {};
  const double spread = fourths - squares * squares / weight;
  return {2.0 * (along_squares - squares / weight * sum) / spread, 2.0 / std::sqrt(spread)};
}

// How the surface bends in the window about the pixel, as far as it is no noise and half of the window shows
// it, too: a step at the window's end is no bend.
glm::dvec2 bend_m(const Neighbourhood &around, const FittedPlane &plane, const OddPart &odd, int n) {
  const double noise_m = std::fmax(around.noise_m(), odd.deviation_m);
  const auto along = [&](glm::ivec2 step) {
    double least_m = std::numeric_limits<double>::max(), sign = 0.0;
    for (const int reach : {n, (n + 1) / 2}) {
      const SecondDifference second = second_difference(around, plane, step, reach);
      least_m = std::min(least_m, beyond_noise(std::abs(second.value_m), second.deviation * noise_m));
      sign += std::copysign(0.5, second.value_m);
    }
    return sign * least_m;
  };
  return {along({1, 0}), along({0, 1})};
}

glm::dvec2 nearest_bend_m(const Neighbourhood &around, const FittedPlane &plane) {
  return {second_difference(around, plane, {1, 0}, 1).value_m,
          second_difference(around, plane, {0, 1}, 1).value_m};
}

SurfaceFit surface_of(const Neighbourhood &around, const FittedPlane &plane, double uncertainty_rad) {
  const PixelFrame &frame = around.frame();
  if (uncertainty_rad > no_plane_rad || !(plane.g.x > 0.0))
    return {-frame.along};
  const glm::dvec3 g = plane.g.x * frame.along + plane.g.y * frame.across + plane.g.z * frame.down;
  return {-glm::normalize(g), uncertainty_rad};
}

SurfaceFit surface_about(const Neighbourhood &around, const FittedPlane &plane, double uncertainty_rad,
                         const OddPart &odd, int n) {
  SurfaceFit surface = surface_of(around, plane, uncertainty_rad);
  surface.one_sided = false;
  surface.bend_m = bend_m(around, plane, odd, n);
  surface.nearest_bend_m = nearest_bend_m(around, plane);
  return surface;
}

SurfaceFit fit_surface(const Neighbourhood &around, int n) {
  const std::optional<FittedPlane> about = fitted_plane(around, {-n, n, -n, n});
  if (about && about->residual_m < sure_noises * std::fmax(around.noise_m(), rounding * around.range_m(0, 0)))
    return surface_about(around, *about, about->uncertainty_rad, odd_part(around, n, *about), n);
  const std::array<std::optional<FittedPlane>, 4> beside{
      fitted_plane(around, {-2 * n, 0, -n, n}), fitted_plane(around, {0, 2 * n, -n, n}),
      fitted_plane(around, {-n, n, -2 * n, 0}), fitted_plane(around, {-n, n, 0, 2 * n})};
  std::optional<FittedPlane> best;
  double best_rad = about ? about->uncertainty_rad / better_beside : 1.0;
  const auto offer = [&](const std::optional<FittedPlane> &plane) {
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
  if (!best && about) {
    const OddPart odd = odd_part(around, n, *about);
    return surface_about(around, *about, smooth_uncertainty_rad(odd, *about, beside), odd, n);
  }
  SurfaceFit surface =
      best ? surface_of(around, *best, bent_beside * best_rad) : SurfaceFit{-around.frame().along};
  surface.one_sided = !best || !around.ends_at_border(n); // beyond the image nothing can be
  surface.off_m = best ? beyond_noise(best->residual_m, std::fmax(around.noise_m(), 0.0)) : 0.0;
  return surface;
}

// How normals turn from a pixel to the next, `step` values on, as far as it is no noise; 0 where they are not
// those of pixels themselves.
glm::dvec3 turn(const std::vector<SurfaceFit> &fits, std::size_t pixel, std::size_t step, bool has_both) {
  if (!has_both || fits[pixel - step].one_sided || fits[pixel].one_sided || fits[pixel + step].one_sided)
    return glm::dvec3(0.0);
  const double uncertainty_rad = std::max(
      {fits[pixel - step].uncertainty_rad, fits[pixel].uncertainty_rad, fits[pixel + step].uncertainty_rad});
  return beyond_noise(0.5 * (fits[pixel + step].normal - fits[pixel - step].normal), uncertainty_rad);
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

// A pixel that alone lies off makes the bend three times as different from that of the neighbours; and noise
// makes it 4.2 times as large as itself.
double off_m(const std::vector<SurfaceFit> &fits, const glm::uvec2 &resolution, glm::uvec2 at,
             double noise_m) {
  const std::size_t pixel = std::size_t{at.y} * resolution.x + at.x;
  const auto bend_m = [&](std::size_t of) { return fits[of].nearest_bend_m; };
  glm::dvec2 difference(0.0);
  if (at.x > 0 && at.x + 1 < resolution.x)
    difference.x = bend_m(pixel).x - 0.5 * (bend_m(pixel - 1).x + bend_m(pixel + 1).x);
  if (at.y > 0 && at.y + 1 < resolution.y)
    difference.y = bend_m(pixel).y - 0.5 * (bend_m(pixel - resolution.x).y + bend_m(pixel + resolution.x).y);
  return beyond_noise(std::max(std::abs(difference.x), std::abs(difference.y)), 4.2 * noise_m) / 3.0;
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
  const double noise_m = std::fmax(image.noise_m, 0.0);
  tbb::parallel_for(0u, image.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < image.resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * image.resolution.x + column;
      SurfaceFit &fit = compared[pixel];
      // The planes of large windows turn where a window meets a step or an edge, too.
      if (n == 1 || fit.bend_m.x != 0.0)
        fit.turn_columns = turn(fits, pixel, 1, column > 0 && column + 1 < image.resolution.x);
      if (n == 1 || fit.bend_m.y != 0.0)
        fit.turn_rows = turn(fits, pixel, image.resolution.x, row > 0 && row + 1 < image.resolution.y);
      fit.off_m = std::max(fit.off_m, off_m(fits, image.resolution, {column, row}, noise_m));
      fit.uncertainty_rad =
          std::max({fit.uncertainty_rad, disagreement_rad(fits, image.resolution, {column, row}),
                    gains[pixel] * turn_rad(fits, image.resolution, {column, row})});
    }
  });
  return compared;
}

} // namespace pmdsim
