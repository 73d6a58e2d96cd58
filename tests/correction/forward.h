#pragma once
// Measured phases of surfaces with a formula: eq. 7 written out diode by diode, with the lens and the rays of
// a plain pinhole, in double. Shares nothing with what it tests.

#include "engine/correction/correction.h"

#include <cmath>
#include <complex>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace pmdsim::test {

inline constexpr double promised_m = 2e-6; // of flat and smooth surfaces without noise
inline constexpr double solved_m = 1e-8;   // where the model is exact: what the search leaves

// What a ray from the lens meets, in the camera frame; the normal towards the lens. A range that is not
// finite: nothing.
struct Met {
  double range_m;
  glm::dvec3 normal;
};
using SurfaceFormula = std::function<Met(const glm::dvec3 &ray)>;

inline SurfaceFormula wall(const glm::dvec3 &through_m, const glm::dvec3 &direction) {
  const glm::dvec3 normal = glm::normalize(direction);
  return [=](const glm::dvec3 &ray) {
    return Met{glm::dot(normal, through_m) / glm::dot(normal, ray),
               glm::dot(normal, ray) < 0.0 ? normal : -normal};
  };
}

inline SurfaceFormula ball(const glm::dvec3 &centre_m, double radius_m) {
  return [=](const glm::dvec3 &ray) {
    const double along = glm::dot(ray, centre_m),
                 square = along * along - glm::dot(centre_m, centre_m) + radius_m * radius_m;
    if (square < 0.0)
      return Met{std::nan(""), -ray};
    const double range_m = along - std::sqrt(square);
    return Met{range_m, (range_m * ray - centre_m) / radius_m};
  };
}

// The nearer one.
inline SurfaceFormula both(const SurfaceFormula &a, const SurfaceFormula &b) {
  return [=](const glm::dvec3 &ray) {
    const Met of_a = a(ray), of_b = b(ray);
    return of_a.range_m < of_b.range_m || !std::isfinite(of_b.range_m) ? of_a : of_b;
  };
}

// The correlation function, and what N taps make of it.
inline std::complex<double> demodulated(const Sensor &sensor, double phase_rad) {
  constexpr double turn = 2.0 * std::numbers::pi;
  if (sensor.waveform.kind == Waveform::Kind::sine)
    return std::polar(1.0, phase_rad);
  std::complex<double> sum = 0.0;
  for (std::uint32_t k = 0; k < sensor.taps; ++k) {
    const double x = phase_rad - turn * k / sensor.taps;
    double c = 0.0;
    if (sensor.waveform.kind == Waveform::Kind::square)
      c = 1.0 - 2.0 / std::numbers::pi * std::acos(std::cos(x));
    for (std::size_t h = 0; h < sensor.waveform.harmonics.size(); ++h)
      c += sensor.waveform.harmonics[h] * std::cos(static_cast<double>(h + 1) * x);
    sum += 2.0 / sensor.taps * c * std::polar(1.0, turn * k / sensor.taps);
  }
  return sum;
}

// The return of a point, for diodes whose illuminators' frames are the camera's.
inline std::complex<double> return_of(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                                      Backscatter backscatter, const glm::dvec3 &ray, const Met &met,
                                      std::size_t frequency) {
  const glm::dvec3 point = met.range_m * ray;
  const double kappa = 2.0 * std::numbers::pi * sensor.modulation_hz[frequency] / speed_of_light_m_s;
  std::complex<double> z = 0.0;
  for (const Illuminator &illuminator : illuminators)
    for (const Diode &diode : illuminator.diodes) {
      const glm::dvec3 to_diode = diode.position_m - point;
      const double r = glm::length(to_diode), facing = glm::dot(met.normal, to_diode) / r;
      if (facing <= 0.0)
        continue;
      const double cosine = std::max(-glm::dot(diode.axis, to_diode) / r, 0.0);
      const double law =
          diode.pattern.kind == Pattern::Kind::isotropic ? 1.0 : std::pow(cosine, diode.pattern.order);
      const double weight =
          diode.intensity_w_sr * law * (backscatter == Backscatter::lambert ? facing : 1.0) / (r * r);
      z += weight * demodulated(sensor, kappa * (r + met.range_m) + illuminator.modulation_phase_rad);
    }
  return z;
}

// A sensor at the world's origin, and illuminators with it, as the camera's frame.
inline Sensor camera(glm::uvec2 resolution, double focal_length_pixels) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.pixel_pitch_m = glm::dvec2(10e-6);
  sensor.focal_length_m = focal_length_pixels * 10e-6;
  sensor.world_from_camera = Pose{};
  return sensor;
}

inline glm::dvec3 ray_of(const Sensor &sensor, double column, double row) {
  const glm::dvec2 chip =
      (glm::dvec2(column, row) + 0.5 - 0.5 * glm::dvec2(sensor.resolution)) * sensor.pixel_pitch_m;
  return glm::normalize(glm::dvec3(chip, sensor.focal_length_m));
}

inline Illuminator ring(double radius_m, int count, const Pattern &pattern = {}, glm::dvec3 centre_m = {}) {
  Illuminator illuminator;
  illuminator.world_from_illuminator = Pose{};
  for (int k = 0; k < count; ++k) {
    const double angle = 2.0 * std::numbers::pi * (k + 0.5) / count;
    Diode diode;
    diode.position_m = centre_m + radius_m * glm::dvec3(std::cos(angle), std::sin(angle), 0.0);
    diode.pattern = pattern;
    illuminator.diodes.push_back(diode);
  }
  return illuminator;
}

struct Taken {
  MeasuredImage image;
  std::vector<double> range_m; // at the pixels' centres
};

// With sensor.samples x sensor.samples points a pixel.
inline Taken take(const Sensor &sensor, const std::vector<Illuminator> &illuminators,
                  const SurfaceFormula &surface, Backscatter backscatter = Backscatter::lambert,
                  std::size_t frequency = 0) {
  Taken taken;
  for (std::uint32_t row = 0; row < sensor.resolution.y; ++row)
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column) {
      std::complex<double> z = 0.0;
      for (std::uint32_t i = 0; i < sensor.samples; ++i)
        for (std::uint32_t k = 0; k < sensor.samples; ++k) {
          const glm::dvec2 off =
              ((glm::dvec2(i, k) + 0.5) / double(sensor.samples) - 0.5) * sensor.fill_factor;
          const glm::dvec3 ray = ray_of(sensor, column + off.x, row + off.y);
          if (const Met met = surface(ray); std::isfinite(met.range_m))
            z += return_of(sensor, illuminators, backscatter, ray, met, frequency);
        }
      const double phase_rad = std::arg(z);
      taken.image.phase_rad.push_back(z == 0.0          ? std::nan("")
                                      : phase_rad < 0.0 ? phase_rad + 2.0 * std::numbers::pi
                                                        : phase_rad);
      taken.range_m.push_back(surface(ray_of(sensor, column, row)).range_m);
    }
  return taken;
}

// The largest error of pixels with that status, m; 0 where there is none.
inline double largest_error_m(const CorrectedImage &corrected, const std::vector<double> &range_m,
                              PixelStatus status = PixelStatus::corrected) {
  double largest = 0.0;
  for (std::size_t pixel = 0; pixel < range_m.size(); ++pixel)
    if (corrected.status[pixel] == static_cast<std::uint32_t>(status) && std::isfinite(range_m[pixel]))
      largest = std::max(largest, std::abs(corrected.range_m[pixel] - range_m[pixel]));
  return largest;
}

inline std::size_t count(const CorrectedImage &corrected, PixelStatus status) {
  return corrected.counts[static_cast<std::size_t>(status)];
}

} // namespace pmdsim::test
