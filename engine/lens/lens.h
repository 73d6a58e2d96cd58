#pragma once
// The way from a place on the chip to the ray that arrives there, and back, in double: thin lens, chip pose
// (eq. 1) and distortion. Rays are in the camera frame and point from the lens to what is seen.

#include "engine/model/sensor.h"

#include <array>
#include <glm/glm.hpp>
#include <optional>

namespace pmdsim {

class Lens {
public:
  explicit Lens(const Sensor &sensor);

  // Chip coordinates x', y' of a place in the image, in metres. `pixel` counts columns and rows from the
  // image's top left corner; (0.5, 0.5) is the centre of the first pixel.
  glm::dvec2 on_chip_m(const glm::dvec2 &pixel) const;
  // The same count of columns and rows of a place on the chip; the inverse of on_chip_m().
  glm::dvec2 pixel(const glm::dvec2 &chip_m) const;

  // The ray through a place of the chip, unit length; nothing where there is none, because it would lie
  // behind the chip or beyond where the distortion folds over.
  std::optional<glm::dvec3> ray(const glm::dvec2 &chip_m) const;
  // Where on the chip a ray arrives; the inverse of ray(). Nothing where it misses the chip's plane.
  std::optional<glm::dvec2> chip_m(const glm::dvec3 &ray) const;

  // Q = lens_from_chip() * (x', y', 1) is where a place of the chip lies in the camera frame, seen in front
  // of the lens.
  const glm::dmat3 &lens_from_chip() const { return lens_from_chip_; }
  // The slopes under which a ray leaves the lens towards the chip (OpenCV's x'', y''); nothing beyond the
  // fold.
  std::optional<glm::dvec2> distorted(const glm::dvec3 &ray) const;
  // Its inverse, on the branch that begins at the optical axis; unit length.
  std::optional<glm::dvec3> undistorted(const glm::dvec2 &slope) const;

  // The distortion along a radius is r (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8), of slopes or (fisheye) of
  // angles. The r whose distorted radius this is, on the branch that begins at 0; where that folds over
  // before, the fold.
  double radial_inverse(double distorted_radius) const;
  // Where the distortion along a radius folds over or its model ends: the radius, and its distorted radius.
  double fold_radius() const { return largest_radius_; }
  double fold_distorted() const;
  struct Coefficients {
    std::array<double, 4> radial;     // k1, k2, k3, k4
    std::array<double, 2> tangential; // p1, p2
  };
  Coefficients coefficients() const;
  // Whether the model folds over anywhere within its limit (LensFault::beyond_model); by tangential terms it
  // may.
  bool folds() const;

private:
  Distortion distortion_;
  glm::dvec2 pitch_m_, resolution_;
  glm::dmat3 lens_from_chip_, chip_from_lens_;
  double largest_radius_; // undistorted: of a slope (Brown-Conrady), of an angle (fisheye); where the model
                          // folds over
};

// The reason why a sensor's image is impossible; nothing where every place of it has a ray, or may be without
// one (Sensor::dark_beyond_fold).
enum class LensFault {
  chip_behind_lens,
  distortion_folds,
  beyond_model,   // Brown-Conrady 89 degrees off the axis, a fisheye 179.4: no fold, but the model ends
  pixel_too_wide, // distortion: a pixel sees a ray 60 degrees or more off the mean of its rays
};
std::optional<LensFault> lens_fault(const Sensor &sensor);

} // namespace pmdsim
