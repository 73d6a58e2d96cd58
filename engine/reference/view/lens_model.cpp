#include "engine/reference/view/lens_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

// Rays by bisection and Newton's method from the slopes under which they meet the chip by OpenCV's formulas
// (engine/model/sensor.h).

namespace pmdsim::reference {

namespace {

using Coefficients = std::vector<double>; // of 1, q, q^2, ...

double polynomial(const Coefficients &coefficients, double q) {
  double value = 0.0;
  for (std::size_t i = coefficients.size(); i-- > 0;)
    value = value * q + coefficients[i];
  return value;
}

// The first double between `from` (where `before` holds) and `to` (where it does not) at which it does not.
template <class Predicate>
double bisect(double from, double to, const Predicate &before) {
  for (double middle = 0.5 * (from + to); middle > from && middle < to; middle = 0.5 * (from + to))
    (before(middle) ? from : to) = middle;
  return to;
}

// Where the polynomial changes its sign between 0 and `limit`, in rising order: once at most between
// neighbouring roots of its derivative.
std::vector<double> sign_changes(const Coefficients &coefficients, double limit) {
  if (coefficients.size() < 2)
    return {};
  Coefficients derivative;
  for (std::size_t i = 1; i < coefficients.size(); ++i)
    derivative.push_back(static_cast<double>(i) * coefficients[i]);
  std::vector<double> ends = sign_changes(derivative, limit);
  ends.push_back(limit);

  std::vector<double> changes;
  double from = 0.0;
  for (const double to : ends) {
    const bool positive = polynomial(coefficients, from) > 0;
    const auto before = [&](double q) { return (polynomial(coefficients, q) > 0) == positive; };
    if (!before(to))
      changes.push_back(bisect(from, to, before));
    from = to;
  }
  return changes;
}

// g(r) = r (1 + k1 r^2 + k2 r^4 + ...) from the optical axis, r = 0, to where it first stops to rise.
class RadialPolynomial {
public:
  // From 1, k1, k2, ...; `largest_radius`: where the branch ends though it still rises.
  RadialPolynomial(Coefficients coefficients, double largest_radius)
      : coefficients_(std::move(coefficients)), end_(largest_radius) {
    Coefficients slope = coefficients_; // of g', a polynomial of q = r^2
    for (std::size_t i = 0; i < slope.size(); ++i)
      slope[i] *= static_cast<double>(2 * i + 1);
    const auto folds = sign_changes(slope, largest_radius * largest_radius);
    if (!folds.empty())
      end_ = std::sqrt(folds.front());
  }

  double value(double radius) const { return radius * polynomial(coefficients_, radius * radius); }
  double end() const { return end_; } // the largest radius of the branch

  // The radius on the branch where g is `value` >= 0, to the last bit; nothing beyond the branch's end.
  std::optional<double> inverse(double value) const {
    double beyond = std::min(value, end_);
    while (this->value(beyond) < value && beyond < end_)
      beyond = std::min(2.0 * beyond, end_);
    if (this->value(beyond) < value)
      return std::nullopt;
    return bisect(0.0, beyond, [&](double radius) { return this->value(radius) < value; });
  }

private:
  Coefficients coefficients_; // of 1, r^2, r^4, ... in g(r) / r
  double end_;
};

glm::dvec2 slopes_of(const glm::dvec3 &place) { return glm::dvec2(place) / place.z; }

// `length` long in the direction of `along`; zero has no direction.
glm::dvec2 of_length(double length, const glm::dvec2 &along) {
  const double present = glm::length(along);
  return present > 0 ? along * (length / present) : glm::dvec2(0.0);
}

class BrownConradyLens {
public:
  explicit BrownConradyLens(const BrownConrady &distortion)
      : distortion_(distortion), radial_({1.0, distortion.k1, distortion.k2, distortion.k3}, largest_slope) {}

  std::optional<glm::dvec3> operator()(const glm::dvec3 &place_m) const {
    const auto slopes = undistorted(slopes_of(place_m));
    return slopes ? std::optional(glm::dvec3(*slopes, 1.0)) : std::nullopt;
  }

private:
  // Rays so close to 90 degrees are beyond what slopes can say.
  static constexpr double largest_slope = 1e8;

  glm::dvec2 distorted(const glm::dvec2 &slopes) const {
    const auto &[k1, k2, p1, p2, k3] = distortion_;
    const auto [x, y] = std::pair(slopes.x, slopes.y);
    const double r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }

  // Symmetric, as the distortion is the gradient of a potential.
  glm::dmat2 jacobian(const glm::dvec2 &slopes) const {
    const auto &[k1, k2, p1, p2, k3] = distortion_;
    const auto [x, y] = std::pair(slopes.x, slopes.y);
    const double r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double radial_slope = k1 + r2 * (2 * k2 + r2 * 3 * k3); // d radial / d r2
    const double xx = radial + 2 * x * x * radial_slope + 2 * p1 * y + 6 * p2 * x;
    const double xy = 2 * x * y * radial_slope + 2 * p1 * x + 2 * p2 * y;
    const double yy = radial + 2 * y * y * radial_slope + 6 * p1 * y + 2 * p2 * x;
    return {xx, xy, xy, yy};
  }

  // The Jacobian is positive definite: the branch that begins at the optical axis has not folded here.
  bool rises(const glm::dvec2 &slopes) const {
    const glm::dmat2 j = jacobian(slopes);
    return j[0][0] > 0 && glm::determinant(j) > 0;
  }

  // Nor has it folded on the way here, behind which another branch could rise again.
  bool rises_from_axis(const glm::dvec2 &slopes) const {
    constexpr int places = 16;
    for (int i = 1; i <= places; ++i)
      if (!rises(slopes * (static_cast<double>(i) / places)))
        return false;
    return true;
  }

  // One step of Newton's method, shortened until it comes nearer to what is wanted and stays on the branch;
  // nothing where no step does.
  std::optional<glm::dvec2> nearer(const glm::dvec2 &slopes, const glm::dvec2 &wanted) const {
    const glm::dvec2 missing = wanted - distorted(slopes);
    const glm::dvec2 step = glm::inverse(jacobian(slopes)) * missing;
    constexpr int most_halvings = 10;
    for (int halvings = 0; halvings < most_halvings; ++halvings) {
      const glm::dvec2 there = slopes + std::ldexp(1.0, -halvings) * step;
      if (rises(there) && glm::length(wanted - distorted(there)) < glm::length(missing))
        return there;
    }
    return std::nullopt;
  }

  std::optional<glm::dvec2> undistorted(const glm::dvec2 &wanted) const {
    const double radius = glm::length(wanted);
    if (distortion_.p1 == 0 && distortion_.p2 == 0) {
      const auto undistorted_radius = radial_.inverse(radius);
      return undistorted_radius ? std::optional(of_length(*undistorted_radius, wanted)) : std::nullopt;
    }
    // The tangential terms are small against the radial ones: they move the solution, and the fold, a little.
    const double start_radius = *radial_.inverse(std::min(radius, 0.999 * radial_.value(radial_.end())));
    glm::dvec2 slopes = of_length(start_radius, wanted);
    constexpr int most_steps = 50;
    for (int i = 0; i < most_steps; ++i) {
      const auto next = nearer(slopes, wanted);
      if (!next)
        break;
      slopes = *next;
    }
    constexpr double rounding = 1e3 * std::numeric_limits<double>::epsilon();
    const bool found = glm::length(wanted - distorted(slopes)) <= rounding * radius;
    return found && rises_from_axis(slopes) ? std::optional(slopes) : std::nullopt;
  }

  BrownConrady distortion_;
  RadialPolynomial radial_; // of the slopes
};

struct FisheyeLens {
  RadialPolynomial radial; // of the angle

  std::optional<glm::dvec3> operator()(const glm::dvec3 &place_m) const {
    const glm::dvec2 slopes = slopes_of(place_m);
    const auto angle_rad = radial.inverse(glm::length(slopes));
    if (!angle_rad)
      return std::nullopt;
    return glm::dvec3(of_length(std::sin(*angle_rad), slopes), std::cos(*angle_rad));
  }
};

using RayTo = std::function<std::optional<glm::dvec3>(const glm::dvec3 &place_m)>;

RayTo lens_with(std::monostate) {
  return [](const glm::dvec3 &place_m) { return place_m; };
}
RayTo lens_with(const BrownConrady &distortion) { return BrownConradyLens(distortion); }
RayTo lens_with(const Fisheye &of) {
  return FisheyeLens{RadialPolynomial({1.0, of.k1, of.k2, of.k3, of.k4}, std::numbers::pi)};
}

// D1(alpha) D2(beta) D3(gamma): active, right-handed rotations about x, y and z.
glm::dmat3 chip_rotation(const glm::dvec3 &angles_rad) {
  const glm::dvec3 c = glm::cos(angles_rad), s = glm::sin(angles_rad);
  const glm::dmat3 d1({1, 0, 0}, {0, c.x, s.x}, {0, -s.x, c.x});
  const glm::dmat3 d2({c.y, 0, -s.y}, {0, 1, 0}, {s.y, 0, c.y});
  const glm::dmat3 d3({c.z, s.z, 0}, {-s.z, c.z, 0}, {0, 0, 1});
  return d1 * d2 * d3;
}

double from_pixel_centre(std::uint32_t sample, std::uint32_t samples_per_pixel) {
  return (sample % samples_per_pixel + 0.5) / samples_per_pixel - 0.5;
}

} // namespace

LensModel::LensModel(const Sensor &sensor)
    : sensor_(sensor), chip_rotation_(chip_rotation(sensor.chip.rotation_rad)),
      origin_m_(glm::dvec3(0, 0, sensor.image_distance_m()) + sensor.chip.translation_m),
      ray_to_(std::visit([](const auto &distortion) { return lens_with(distortion); }, sensor.distortion)) {}

std::optional<glm::dvec3> LensModel::sample_ray(const glm::uvec2 &sample) const {
  const glm::dvec2 pixel(sample / sensor_.samples), resolution(sensor_.resolution);
  const glm::dvec2 in_pixel(from_pixel_centre(sample.x, sensor_.samples),
                            from_pixel_centre(sample.y, sensor_.samples));
  const glm::dvec2 chip_m =
      (pixel + 0.5 - 0.5 * resolution + in_pixel * sensor_.fill_factor) * sensor_.pixel_pitch_m;
  const glm::dvec3 place_m = origin_m_ + chip_rotation_ * glm::dvec3(chip_m, 0.0);
  if (!(place_m.z > 0))
    return std::nullopt;
  const auto ray = ray_to_(place_m);
  return ray ? std::optional(glm::normalize(*ray)) : std::nullopt;
}

double LensModel::vignetting_gain(const glm::dvec3 &ray) const {
  if (sensor_.vignetting == Vignetting::none)
    return 1.0;
  const double cosine = std::max(ray.z, 0.0);
  return cosine * cosine * cosine * cosine;
}

} // namespace pmdsim::reference
