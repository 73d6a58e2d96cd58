#pragma once
// Lens distortion both ways: from a ray to the slopes under which it meets the chip by OpenCV's formulas
// (engine/model/sensor.h), and back by bisection and Newton's method.

#include "engine/model/sensor.h"
#include "engine/reference/view/radial_polynomial.h"

#include <glm/glm.hpp>
#include <optional>

namespace pmdsim::reference {

// Each lens has
//   slopes(ray): the formula, wherever it is defined, folded or not;
//   ray(place): its inverse, not normalised, for a place of the chip seen in front of the lens (z > 0), on
//     the branch that begins at the optical axis; nothing where that branch folds before it.

class PinholeLens {
public:
  std::optional<glm::dvec2> slopes(const glm::dvec3 &ray) const;
  std::optional<glm::dvec3> ray(const glm::dvec3 &place_m) const { return place_m; }
};

class BrownConradyLens {
public:
  explicit BrownConradyLens(const BrownConrady &distortion);

  std::optional<glm::dvec2> slopes(const glm::dvec3 &ray) const;
  std::optional<glm::dvec3> ray(const glm::dvec3 &place_m) const;

private:
  glm::dvec2 distorted(const glm::dvec2 &slopes) const;
  // Symmetric, as the distortion is the gradient of a potential.
  glm::dmat2 jacobian(const glm::dvec2 &slopes) const;
  bool rises(const glm::dvec2 &slopes) const;
  bool rises_from_axis(const glm::dvec2 &slopes) const;
  std::optional<glm::dvec2> nearer(const glm::dvec2 &slopes, const glm::dvec2 &wanted) const;
  std::optional<glm::dvec2> undistorted(const glm::dvec2 &wanted) const;

  BrownConrady distortion_;
  RadialPolynomial radial_; // of the slopes
};

class FisheyeLens {
public:
  explicit FisheyeLens(const Fisheye &distortion);

  std::optional<glm::dvec2> slopes(const glm::dvec3 &ray) const;
  std::optional<glm::dvec3> ray(const glm::dvec3 &place_m) const;

private:
  RadialPolynomial radial_; // of the angle
};

} // namespace pmdsim::reference
