#pragma once
// Bounds of what is visible from a place: how near it is, and how far to the sides.

#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

// Bounds for points P of some visible boxes, seen from a place.
struct DirectionalBounds {
  double range_m;            // |P| at least
  glm::dvec3 least, largest; // of P / |P| along each of three unit vectors
  double beam_cosine;        // b . P / |P| at least, for a unit vector b; below 0 where a point is behind
};

// The boxes cut until they are small against their distance from `around` (or too many), so that the bounds
// of a DirectionalBounds say something about each.
std::vector<VisibleBox> pieces_of(const std::vector<VisibleBox> &visible, const VisibleBox &around);

// A DirectionalBounds for each half octave of the distance from `place_m`; the columns of `axes` are the
// three unit vectors.
std::vector<DirectionalBounds> directional_bounds(const std::vector<VisibleBox> &pieces,
                                                  const glm::dvec3 &place_m, const glm::dmat3 &axes,
                                                  const glm::dvec3 &beam);

// The nearest and the farthest that points of two boxes can be apart.
double least_distance_m(const VisibleBox &a, const VisibleBox &b);
double largest_distance_m(const VisibleBox &a, const VisibleBox &b);

} // namespace pmdsim
