#pragma once
// The surface around each pixel, from the ranges of its neighbours: planes that are fitted to windows of
// pixels, of which none is to reach across a step or an edge.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

// Row-major, rows * columns values, which outlive it.
struct RangeImage {
  glm::uvec2 resolution;                // columns, rows
  std::span<const glm::dvec3> ray;      // unit length, camera frame
  std::span<const double> range_m;      // not finite where there is none
  std::span<const glm::dvec3> normal{}; // for which the ranges were found
  // How a range changes with its normal, m for each unit; empty: not at all.
  std::span<const glm::dvec3> per_normal_m{};
  double noise_m = 0.0; // of ranges: what a plane may be off
};

struct SurfaceFit {
  glm::dvec3 normal{0.0};       // unit length, towards the lens; towards it at all where no plane fits
  double uncertainty_rad = 1.0; // of the normal: how far it may be off, estimated
  // The plane fits pixels beside this one only, to which it need not belong: where two surfaces meet, some
  // pixels of one lie in the plane of the other.
  bool one_sided = true;
  // How far the surface bends away from its plane, along the columns and along the rows: second differences
  // of range; 0 where the window reaches to one side only.
  glm::dvec2 bend_m{0.0};
  // How far the pixel lies off the surface that bends as it does at its neighbours, estimated.
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

// The standard deviation of single ranges, by what is left of the neighbours of a pixel when the part that is
// even about it is taken off, which a curved surface leaves, too. It is found where the image is smoothest,
// in a fifth of it. NaN where no pixel has all eight neighbours.
double noise_of(const RangeImage &image);

// The distance of points of neighbouring pixels, if surfaces faced the lens: the median. NaN likewise.
double spacing_of(const RangeImage &image);

// The least n with which a normal is uncertain by 20 mrad or less, by noise; at most 8.
std::uint32_t fit_pixels_for(double noise_m, double spacing_m);

} // namespace pmdsim
