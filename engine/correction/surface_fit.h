#pragma once
// The surface around each pixel, from the ranges of its neighbours: planes that are fitted to windows of
// pixels, of which none is to reach across a step or an edge.

#include "engine/correction/range_image.h"

#include <cstdint>
#include <vector>

namespace pmdsim {

struct SurfaceFit {
  glm::dvec3 normal{0.0};       // unit length, towards the lens; towards it at all where no plane fits
  double uncertainty_rad = 1.0; // of the normal: how far it may be off, estimated
  // The plane fits pixels beside this one only, to which it need not belong: where two surfaces meet, some
  // pixels of one lie in the plane of the other.
  bool one_sided = true;
  // How far the surface bends away from its plane, along the columns and along the rows: second differences
  // of range in the window, as far as they are no noise; 0 where the window reaches to one side only.
  glm::dvec2 bend_m{0.0};
  // The same of the pixel and its neighbours alone, with their noise.
  glm::dvec2 nearest_bend_m{0.0};
  // How the normal turns from a pixel to the next, along the columns and along the rows; 0 likewise.
  glm::dvec3 turn_columns{0.0}, turn_rows{0.0};
  // How far the pixel lies off the surface that bends as it does at its neighbours, beyond noise, estimated.
  double off_m = 0.0;
};

// On surfaces as smooth as pixels can tell, an inverse range is linear in the ray: 1 / r = g . u, of a plane
// with the normal along g. For each pixel the plane is fitted to a window of (2 n + 1) x (2 n + 1) pixels
// about it, or, where that fits clearly better, to one on whose border it lies, on any of eight sides, or to
// the half of one at whose corner it lies.
//
// Where a range depends much on its normal, more than points lie apart, ranges found with one another's
// normals and normals found by one another's ranges never settle. There the ranges of a window are taken for
// the normal of its plane, to first order, all of them alike.
std::vector<SurfaceFit> fit_surfaces(const RangeImage &image, std::uint32_t n);

} // namespace pmdsim
