#include "engine/lens/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace pmdsim {
namespace {

// Brown-Conrady is taken up to 89 degrees from the axis, where its slopes end, the fisheye up to nearly the
// point behind.
constexpr double largest_slope = 57.29;
constexpr double largest_angle_rad = 0.997 * std::numbers::pi;

// Coefficients from the constant term on.
using Polynomial = std::vector<double>;

double value_at(std::span<const double> polynomial, double x) {
  double value = 0.0;
  for (auto c = polynomial.rbegin(); c != polynomial.rend(); ++c)
    value = value * x + *c;
  return value;
}

// Where the polynomial times `sign` stops being positive between `low`, where it is, and `high`.
double crossing(const Polynomial &polynomial, double sign, double low, double high) {
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle == low || middle == high)
      break;
    (sign * value_at(polynomial, middle) > 0.0 ? low : high) = middle;
  }
  return low;
}

// The stationary points of a polynomial cut its domain into parts on which it is monotone, so they are found
// first.
std::vector<double> sign_changes(const Polynomial &polynomial, double high) {
  if (polynomial.size() < 2)
    return {};
  Polynomial derivative;
  for (std::size_t n = 1; n < polynomial.size(); ++n)
    derivative.push_back(static_cast<double>(n) * polynomial[n]);
  std::vector<double> borders = sign_changes(derivative, high);
  borders.insert(borders.begin(), 0.0);
  borders.push_back(high);
  std::vector<double> changes;
  for (std::size_t i = 1; i < borders.size(); ++i) {
    const bool falls = value_at(polynomial, borders[i - 1]) > 0.0;
    if (falls != (value_at(polynomial, borders[i]) > 0.0))
      changes.push_back(crossing(polynomial, falls ? 1.0 : -1.0, borders[i - 1], borders[i]));
  }
  return changes;
}

// The coefficients c of r (1 + c1 r^2 + c2 r^4 + ...), which both models use along the radius.
std::array<double, 4> radial_coefficients(const Distortion &distortion) {
  if (const auto *brown = std::get_if<BrownConrady>(&distortion))
    return {brown->k1, brown->k2, brown->k3, 0.0};
  if (const auto *fisheye = std::get_if<Fisheye>(&distortion))
    return {fisheye->k1, fisheye->k2, fisheye->k3, fisheye->k4};
  return {};
}

double stretch(const std::array<double, 4> &c, double r2) {
  return 1.0 + r2 * (c[0] + r2 * (c[1] + r2 * (c[2] + r2 * c[3])));
}

// d/dr of the radial polynomial, of r^2.
Polynomial radial_slope(const std::array<double, 4> &c) {
  return {1.0, 3.0 * c[0], 5.0 * c[1], 7.0 * c[2], 9.0 * c[3]};
}

struct Distorted {
  glm::dvec2 slope;
  glm::dmat2 jacobian; // of the distorted slope by the undistorted one
};

Distorted brown_conrady(const BrownConrady &d, const glm::dvec2 &s) {
  const double r2 = glm::dot(s, s);
  const double radial = 1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const double by_r2 = d.k1 + r2 * (2.0 * d.k2 + r2 * 3.0 * d.k3);
  const double mixed = 2.0 * (s.x * s.y * by_r2 + d.p1 * s.x + d.p2 * s.y);
  return {{s.x * radial + 2.0 * d.p1 * s.x * s.y + d.p2 * (r2 + 2.0 * s.x * s.x),
           s.y * radial + d.p1 * (r2 + 2.0 * s.y * s.y) + 2.0 * d.p2 * s.x * s.y},
          {radial + 2.0 * s.x * s.x * by_r2 + 2.0 * d.p1 * s.y + 6.0 * d.p2 * s.x, mixed, mixed,
           radial + 2.0 * s.y * s.y * by_r2 + 6.0 * d.p1 * s.y + 2.0 * d.p2 * s.x}};
}

// Judged by its residual: near the fold the root itself is ill-conditioned.
std::optional<glm::dvec2> brown_conrady_inverse(const BrownConrady &d, const glm::dvec2 &slope,
                                                const glm::dvec2 &start) {
  const double rounding = 8e-15 * (1.0 + glm::length(slope));
  glm::dvec2 s = start;
  for (int i = 0; i < 60; ++i) {
    const auto [distorted, jacobian] = brown_conrady(d, s);
    if (!(glm::determinant(jacobian) > 0.0))
      return std::nullopt;
    if (glm::distance(slope, distorted) <= rounding)
      return s;
    s += glm::inverse(jacobian) * (slope - distorted);
  }
  return std::nullopt;
}

glm::dmat3 chip_rotation(const glm::dvec3 &angles_rad) {
  const glm::dvec3 c = glm::cos(angles_rad), s = glm::sin(angles_rad);
  const glm::dmat3 d1(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);
  const glm::dmat3 d2(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
  const glm::dmat3 d3(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
  return d1 * d2 * d3;
}

glm::dmat3 lens_from_chip_of(const Sensor &sensor) {
  const glm::dmat3 rotation = chip_rotation(sensor.chip.rotation_rad);
  return {rotation[0], rotation[1],
          glm::dvec3(0.0, 0.0, sensor.image_distance_m()) + sensor.chip.translation_m};
}

double model_limit(const Distortion &distortion) {
  return std::holds_alternative<Fisheye>(distortion) ? largest_angle_rad : largest_slope;
}

double largest_radius_of(const Distortion &distortion) {
  const double limit = model_limit(distortion);
  const auto folds = sign_changes(radial_slope(radial_coefficients(distortion)), limit * limit);
  return folds.empty() ? limit : std::sqrt(folds.front());
}

} // namespace

Lens::Lens(const Sensor &sensor)
    : distortion_(sensor.distortion), pitch_m_(sensor.pixel_pitch_m), resolution_(sensor.resolution),
      lens_from_chip_(lens_from_chip_of(sensor)), chip_from_lens_(glm::inverse(lens_from_chip_)),
      largest_radius_(largest_radius_of(sensor.distortion)) {}

glm::dvec2 Lens::on_chip_m(const glm::dvec2 &pixel) const { return (pixel - 0.5 * resolution_) * pitch_m_; }

glm::dvec2 Lens::pixel(const glm::dvec2 &chip_m) const { return chip_m / pitch_m_ + 0.5 * resolution_; }

std::optional<glm::dvec3> Lens::ray(const glm::dvec2 &chip_m) const {
  const glm::dvec3 place = lens_from_chip_ * glm::dvec3(chip_m, 1.0);
  if (!(place.z > 0.0))
    return std::nullopt;
  return undistorted(glm::dvec2(place) / place.z);
}

std::optional<glm::dvec2> Lens::chip_m(const glm::dvec3 &ray) const {
  const std::optional<glm::dvec2> slope = distorted(ray);
  if (!slope)
    return std::nullopt;
  const glm::dvec3 place = chip_from_lens_ * glm::dvec3(*slope, 1.0);
  if (!(place.z > 0.0))
    return std::nullopt;
  return glm::dvec2(place) / place.z;
}

std::optional<glm::dvec2> Lens::distorted(const glm::dvec3 &ray) const {
  const double across = glm::length(glm::dvec2(ray));
  if (const auto *fisheye = std::get_if<Fisheye>(&distortion_)) {
    const double theta_rad = std::atan2(across, ray.z);
    if (theta_rad > largest_radius_)
      return std::nullopt;
    const double radius = theta_rad * stretch(radial_coefficients(*fisheye), theta_rad * theta_rad);
    return across > 0.0 ? glm::dvec2(ray) * (radius / across) : glm::dvec2(0.0);
  }
  if (!(ray.z > 0.0))
    return std::nullopt;
  const glm::dvec2 slope = glm::dvec2(ray) / ray.z;
  const auto *brown = std::get_if<BrownConrady>(&distortion_);
  if (!brown)
    return slope;
  return across <= largest_radius_ * ray.z ? std::optional(brown_conrady(*brown, slope).slope) : std::nullopt;
}

double Lens::radial_inverse(double distorted_radius) const {
  const auto c = radial_coefficients(distortion_);
  const Polynomial slope = radial_slope(c);
  double low = 0.0, high = largest_radius_, r = std::min(distorted_radius, largest_radius_);
  for (int i = 0; i < 200; ++i) {
    const double excess = r * stretch(c, r * r) - distorted_radius;
    (excess > 0.0 ? high : low) = r;
    double next = r - excess / value_at(slope, r * r);
    // Newton's steps may go round in circles where the polynomial is S-shaped; every third halves the
    // bracket.
    if (i % 3 == 2 || !(next >= low && next <= high))
      next = 0.5 * (low + high);
    if (next == r)
      break;
    r = next;
  }
  return r;
}

double Lens::fold_distorted() const {
  return largest_radius_ * stretch(radial_coefficients(distortion_), largest_radius_ * largest_radius_);
}

bool Lens::folds() const {
  const auto *brown = std::get_if<BrownConrady>(&distortion_);
  return largest_radius_ < model_limit(distortion_) || (brown && (brown->p1 != 0.0 || brown->p2 != 0.0));
}

Lens::Coefficients Lens::coefficients() const {
  const auto *brown = std::get_if<BrownConrady>(&distortion_);
  return {radial_coefficients(distortion_), {brown ? brown->p1 : 0.0, brown ? brown->p2 : 0.0}};
}

std::optional<glm::dvec3> Lens::undistorted(const glm::dvec2 &slope) const {
  if (std::holds_alternative<std::monostate>(distortion_))
    return glm::normalize(glm::dvec3(slope, 1.0));
  const double radius = glm::length(slope);
  const double inverse = radial_inverse(radius);
  const glm::dvec2 outward = radius > 0.0 ? slope / radius : glm::dvec2(0.0);
  if (const auto *brown = std::get_if<BrownConrady>(&distortion_)) {
    auto found = brown_conrady_inverse(*brown, slope, inverse * outward);
    if (!found && radius > 0.0) // by tangential terms the fold is no circle, and the start lay beyond it
      found = brown_conrady_inverse(*brown, slope, 0.8 * inverse * outward);
    return found && glm::length(*found) <= largest_radius_
               ? std::optional(glm::normalize(glm::dvec3(*found, 1.0)))
               : std::nullopt;
  }
  // The image ends at the fold.
  return radius < fold_distorted() ? std::optional(glm::dvec3(std::sin(inverse) * outward, std::cos(inverse)))
                                   : std::nullopt;
}

namespace {

// The fault of the ray through a place of the image.
std::optional<LensFault> fault_at(const Lens &lens, const glm::dvec2 &pixel) {
  if (lens.ray(lens.on_chip_m(pixel)))
    return std::nullopt;
  return lens.folds() ? LensFault::distortion_folds : LensFault::beyond_model;
}

// Along the image's borders, and in a net over it: tangential terms may fold inside, too.
std::optional<LensFault> distortion_fault(const Lens &lens, const glm::uvec2 &last) {
  std::optional<LensFault> fault;
  const auto look = [&](double column, double row) {
    if (!fault)
      fault = fault_at(lens, {column, row});
  };
  for (std::uint32_t column = 0; column <= last.x; ++column) {
    look(column, 0);
    look(column, last.y);
  }
  for (std::uint32_t row = 0; row <= last.y; ++row) {
    look(0, row);
    look(last.x, row);
  }
  constexpr int net = 64;
  for (int i = 1; i < net; ++i)
    for (int j = 1; j < net; ++j)
      look(last.x * (i / double{net}), last.y * (j / double{net}));
  return fault;
}

// Whether a pixel sees a ray 60 degrees or more from the mean of its rays. The largest are few, or on a
// regular net.
bool has_too_wide_pixel(const Lens &lens, const glm::uvec2 &resolution) {
  const glm::uvec2 steps = glm::min(resolution, glm::uvec2(64));
  for (glm::uvec2 step(0); step.y < steps.y; ++step.y)
    for (step.x = 0; step.x < steps.x; ++step.x) {
      const glm::dvec2 pixel(step * (resolution - 1u) / glm::max(steps - 1u, glm::uvec2(1)));
      // Corners, middles of the sides, and the centre, without which a view of nearly everything looks narrow
      // from behind.
      std::array<glm::dvec3, 9> rays;
      glm::dvec3 mean(0.0);
      for (std::size_t k = 0; k < rays.size(); ++k)
        mean += rays[k] =
            lens.ray(lens.on_chip_m(pixel + 0.5 * glm::dvec2(k % 3, k / 3))).value_or(glm::dvec3(0.0));
      mean = glm::normalize(mean);
      if (std::ranges::count(rays, glm::dvec3(0.0)) == 0 &&
          !std::ranges::all_of(rays, [&](const glm::dvec3 &ray) { return glm::dot(ray, mean) > 0.5; }))
        return true;
    }
  return false;
}

} // namespace

std::optional<LensFault> lens_fault(const Sensor &sensor) {
  const Lens lens(sensor);
  const glm::uvec2 &last = sensor.resolution;
  for (const glm::uvec2 corner : {glm::uvec2(0), glm::uvec2(last.x, 0), glm::uvec2(0, last.y), last})
    if (!((lens.lens_from_chip() * glm::dvec3(lens.on_chip_m(corner), 1.0)).z > 0.0))
      return LensFault::chip_behind_lens;
  if (!sensor.has_distortion())
    return std::nullopt;
  if (const auto fault = sensor.dark_beyond_fold ? std::nullopt : distortion_fault(lens, last))
    return fault;
  return has_too_wide_pixel(lens, last) ? std::optional(LensFault::pixel_too_wide) : std::nullopt;
}

} // namespace pmdsim
