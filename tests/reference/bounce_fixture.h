#pragma once
// Frames with light that bounces, and what one bounce must give, by an integral over flat plates that no path
// is traced for.

#include "engine/reference/reference.h"
#include "tests/reference/shadow_fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/units.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace pmdsim::test {

inline reference::Options bouncing(std::uint32_t count, std::uint32_t paths,
                                   const std::vector<std::uint32_t> &pixels = {}) {
  reference::Options options{Shadows::automatic};
  options.bounces.count = count;
  options.paths = paths;
  options.pixels = pixels;
  return options;
}

// A parallelogram in the camera's frame, its front where u x v points to.
struct Plate {
  glm::dvec3 corner_m, u_m, v_m;
  Surface surface;

  glm::dvec3 normal() const { return glm::normalize(glm::cross(u_m, v_m)); }
};

inline Scene scene_of(const std::vector<Plate> &plates) {
  SceneBuilder builder;
  for (const auto &[corner_m, u_m, v_m, surface] : plates)
    builder.add_mesh({corner_m, corner_m + u_m, corner_m + u_m + v_m, corner_m + v_m}, {{0, 1, 2}, {0, 2, 3}},
                     surface);
  return builder.scene();
}

// Two plates face each other, the lens between them.
inline std::vector<Plate> parallel_plates() {
  return {{{-1, -1, 1.5}, {0, 2, 0}, {2, 0, 0}, {0.7}}, {{-1, -1, -0.5}, {2, 0, 0}, {0, 2, 0}, {0.5}}};
}

// A floor and the wall at its end.
inline std::vector<Plate> corner_of_plates() {
  return {{{-1, 0.5, 0.5}, {2, 0, 0}, {0, 0, 1.5}, {0.6}}, {{-1, -0.5, 2}, {0, 1, 0}, {2, 0, 0}, {0.9}}};
}

// A point that the lens at the origin sees, and its diodes, isotropic and all in the camera's frame.
struct LitPoint {
  glm::dvec3 position_m, normal;
  double reflectivity;
  const std::vector<Diode> &diodes;
};

// W/m^2, as a phasor with the way's phase.
inline std::complex<double> irradiance(const glm::dvec3 &point_m, const glm::dvec3 &normal,
                                       const std::vector<Diode> &diodes, double wavenumber_rad_m) {
  std::complex<double> sum;
  for (const Diode &diode : diodes) {
    const glm::dvec3 way_m = diode.position_m - point_m;
    const double range_m = glm::length(way_m), cosine = glm::dot(normal, way_m) / range_m;
    if (cosine > 0)
      sum += std::polar(diode.intensity_w_sr * cosine / (range_m * range_m), wavenumber_rad_m * range_m);
  }
  return sum;
}

// Nodes of an integral from 0 to 1, close together near `centre`, and their weights.
inline std::vector<std::pair<double, double>> nodes_around(double centre, int nodes_a_side) {
  std::vector<std::pair<double, double>> nodes;
  for (const double reach : {-centre, 1 - centre})
    for (int i = 0; i < nodes_a_side && reach != 0; ++i) {
      const double q = (i + 0.5) / nodes_a_side;
      nodes.emplace_back(centre + reach * q * q * q, std::abs(reach) * 3 * q * q / nodes_a_side);
    }
  return nodes;
}

// What comes to the lens from diodes by way of `plate` and `point`, with nothing between them.
inline std::complex<double> one_bounce(const LitPoint &point, const Plate &plate, double wavenumber_rad_m,
                                       int nodes_a_side) {
  const auto nearest = [&](const glm::dvec3 &side_m) {
    return std::clamp(glm::dot(point.position_m - plate.corner_m, side_m) / glm::dot(side_m, side_m), 0.0,
                      1.0);
  };
  const glm::dvec3 normal = plate.normal();
  const double area_m2 = glm::length(glm::cross(plate.u_m, plate.v_m));
  const auto along_v = nodes_around(nearest(plate.v_m), nodes_a_side);
  std::complex<double> sum;
  for (const auto &[u, u_weight] : nodes_around(nearest(plate.u_m), nodes_a_side))
    for (const auto &[v, v_weight] : along_v) {
      const glm::dvec3 from_m = plate.corner_m + u * plate.u_m + v * plate.v_m;
      const glm::dvec3 way_m = from_m - point.position_m;
      const double range_m = glm::length(way_m);
      const double cosines = glm::dot(point.normal, way_m) * -glm::dot(normal, way_m) / (range_m * range_m);
      if (glm::dot(point.normal, way_m) > 1e-9 && cosines > 0)
        sum += u_weight * v_weight * area_m2 * cosines / (range_m * range_m) *
               std::polar(1.0, wavenumber_rad_m * range_m) *
               irradiance(from_m, normal, point.diodes, wavenumber_rad_m);
    }
  return point.reflectivity * plate.surface.reflectivity / (std::numbers::pi * std::numbers::pi) * sum *
         std::polar(1.0, wavenumber_rad_m * glm::length(point.position_m));
}

// By way of all of the plates to a pixel's point on one of them.
inline std::complex<double> one_bounce_of(const std::vector<Plate> &plates, const Sensor &sensor,
                                          const reference::Frame &frame, std::uint32_t pixel,
                                          const std::vector<Diode> &diodes, int nodes_a_side) {
  const Plate &seen = plates.at(frame.object_id[pixel]);
  const LitPoint point{point_seen(sensor, frame, pixel), seen.normal(), seen.surface.reflectivity, diodes};
  const double wavenumber_rad_m = full_turn_rad * sensor.modulation_hz[0] / speed_of_light_m_s;
  std::complex<double> sum;
  for (const Plate &plate : plates)
    if (&plate != &seen)
      sum += one_bounce(point, plate, wavenumber_rad_m, nodes_a_side);
  return sum;
}

inline std::complex<double> indirect_z(const reference::FrameReturn &found, std::size_t pixel) {
  return found.z[pixel] - found.direct_z[pixel];
}

// How much longer the direct light's distance becomes by what bounces.
inline double multipath_of_m(const std::complex<double> &z, const std::complex<double> &direct_z,
                             double ambiguity_m) {
  return ambiguity_m * std::arg(z / direct_z) / full_turn_rad;
}

} // namespace pmdsim::test
