#pragma once
// A sphere about the lens, as a mesh, and what light that bounces within it comes to: from any point of it
// every part of the sphere takes the same share of the light.

#include "engine/model/bounces.h"
#include "engine/model/sensor.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace pmdsim::test {

inline constexpr double sphere_radius_m = 2.0, sphere_reflectivity = 0.8;

struct Sphere {
  double radius_m = sphere_radius_m, reflectivity = sphere_reflectivity;
};

using SphereFacet = std::array<glm::dvec3, 3>; // corners on the unit sphere

inline std::vector<SphereFacet> octahedron() {
  std::vector<SphereFacet> facets;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0})
        facets.push_back({glm::dvec3(x, 0, 0), glm::dvec3(0, y, 0), glm::dvec3(0, 0, z)});
  return facets;
}

inline std::vector<SphereFacet> icosahedron() {
  std::vector<glm::dvec3> corners;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-std::numbers::phi, std::numbers::phi})
      corners.insert(corners.end(), {glm::dvec3(0, a, b), glm::dvec3(a, b, 0), glm::dvec3(b, 0, a)});
  const auto are_beside = [&](std::size_t i, std::size_t k) {
    return std::abs(glm::distance(corners[i], corners[k]) - 2.0) < 1e-9;
  };
  std::vector<SphereFacet> facets;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (are_beside(i, k) && are_beside(k, l) && are_beside(l, i))
          facets.push_back(
              {glm::normalize(corners[i]), glm::normalize(corners[k]), glm::normalize(corners[l])});
  return facets;
}

// Each into four.
inline std::vector<SphereFacet> divided(const std::vector<SphereFacet> &facets) {
  std::vector<SphereFacet> parts;
  for (const auto &[a, b, c] : facets) {
    const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    parts.insert(parts.end(), {SphereFacet{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return parts;
}

// About the lens, its facets' fronts inside.
struct SphereMesh {
  Scene scene;
  double error_m; // how much nearer than the radius its facets come
};

inline SphereMesh sphere_mesh(int divisions, const Sphere &sphere = {},
                              std::vector<SphereFacet> facets = octahedron()) {
  const double radius_m = sphere.radius_m;
  for (int i = 0; i < divisions; ++i)
    facets = divided(facets);
  std::vector<glm::dvec3> corners_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  double nearest_m = radius_m;
  for (auto &[a, b, c] : facets) {
    const glm::dvec3 front = glm::normalize(glm::cross(b - a, c - a));
    nearest_m = std::min(nearest_m, radius_m * std::abs(glm::dot(front, a)));
    if (glm::dot(front, a) > 0)
      std::swap(b, c);
    const auto first = static_cast<std::uint32_t>(corners_m.size());
    corners_m.insert(corners_m.end(), {radius_m * a, radius_m * b, radius_m * c});
    faces.push_back({first, first + 1, first + 2});
  }
  SceneBuilder builder;
  builder.add_mesh(corners_m, faces, {sphere.reflectivity});
  return {builder.scene(), radius_m - nearest_m};
}

// The mean of exp(+j kappa s) over a flight's length s from one point of the sphere to all others: the
// integral of exp(j kappa s) s / (2 R^2) ds from 0 to 2 R.
inline std::complex<double> flight_mean(double wavenumber_rad_m, double radius_m = sphere_radius_m) {
  const std::complex<double> slope(0, wavenumber_rad_m);
  const auto antiderivative = [&](double s) {
    return std::exp(slope * s) * (s / slope - 1.0 / (slope * slope));
  };
  return (antiderivative(2 * radius_m) - antiderivative(0)) / (2 * radius_m * radius_m);
}

// z over its direct part: the sum of (rho G)^k over k = 0 ... bounces.
inline std::complex<double> return_over_direct(std::uint32_t bounces, double modulation_hz,
                                               const Sphere &sphere = {}) {
  const double wavenumber_rad_m = 2.0 * std::numbers::pi * modulation_hz / speed_of_light_m_s;
  const auto ratio = sphere.reflectivity * flight_mean(wavenumber_rad_m, sphere.radius_m);
  const auto left_out = bounces == all_bounces ? 0.0 : std::pow(ratio, static_cast<int>(bounces) + 1);
  return (1.0 - left_out) / (1.0 - ratio);
}

} // namespace pmdsim::test
