#pragma once
// How much longer the paths of some diodes may be than a reference point's, over all that is visible.

#include "engine/view/camera_scene.h"

#include <limits>
#include <span>
#include <vector>

namespace pmdsim {

struct PathDifference {
  double radius_m = 0.0; // of the sphere around the reference point that holds all the diodes
  double range_m =
      std::numeric_limits<double>::infinity(); // at least, from the reference point to what is visible
  double path_difference_m =
      0.0; // at most, |r_nm - rho| over the diodes and all that is visible; <= radius_m
  // Bounds of u = r_nm^2 / rho^2 - 1, likewise; infinite where a point may be as near as the radius.
  double least_stretch = 0.0, most_stretch = 0.0;
  double farthest_m = 0.0; // at most, from the reference point to what is visible

  double radius_over_range() const { return radius_m > 0.0 ? radius_m / range_m : 0.0; }
  bool operator==(const PathDifference &) const = default;
};

// Camera frame.
PathDifference path_difference_of(const glm::dvec3 &reference_m, std::span<const glm::dvec3> diodes_m,
                                  const std::vector<VisibleBox> &visible);

} // namespace pmdsim
