#include "tests/comparison/light_formula.h"

#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <fmt/format.h>

namespace pmdsim::test {

namespace {

constexpr double reflectivity = 0.7;

glm::dvec3 point_of(const Sensor &sensor, std::size_t pixel, double z_m) {
  const glm::dvec2 place(pixel % sensor.resolution.x, pixel / sensor.resolution.x);
  const glm::dvec2 on_chip_m = (place + 0.5 - 0.5 * glm::dvec2(sensor.resolution)) * sensor.pixel_pitch_m;
  return z_m / sensor.focal_length_m * glm::dvec3(on_chip_m, sensor.focal_length_m);
}

struct Path {
  double length_m, weight, phase_turns;
};

std::vector<Path> paths_over(const glm::dvec3 &point_m, const std::vector<Light> &lights,
                             Backscatter backscatter) {
  std::vector<Path> paths;
  for (const Light &light : lights)
    for (const Diode &diode : light.illuminator.diodes) {
      const glm::dvec3 way_m = point_m - diode.position_m;
      const double r_m = glm::length(way_m), cosine = way_m.z / r_m;
      const double per_sr = backscatter == Backscatter::constant
                                ? reflectivity
                                : reflectivity / std::numbers::pi * std::max(0.0, cosine);
      paths.push_back({r_m + glm::length(point_m),
                       diode.intensity_w_sr * light.gain(angles_of(way_m, diode)) * per_sr / (r_m * r_m),
                       light.illuminator.modulation_phase_rad / full_turn_rad});
    }
  return paths;
}

double correlation(const Waveform &waveform, double turns) {
  if (waveform.kind == Waveform::Kind::square)
    return 4.0 * std::abs(turns - std::floor(turns) - 0.5) - 1.0;
  if (waveform.kind == Waveform::Kind::sine)
    return std::cos(full_turn_rad * turns);
  double sum = 0.0;
  for (std::size_t h = 0; h < waveform.harmonics.size(); ++h)
    sum += waveform.harmonics[h] * std::cos(full_turn_rad * static_cast<double>(h + 1) * turns);
  return sum;
}

std::complex<double> return_of(const std::vector<Path> &paths, const Sensor &sensor) {
  std::complex<double> z;
  for (std::uint32_t k = 0; k < sensor.taps; ++k) {
    const double reference_turns = static_cast<double>(k) / sensor.taps;
    double tap = 0.0;
    for (const auto &[length_m, weight, phase_turns] : paths)
      tap += weight * correlation(sensor.waveform, length_m * sensor.modulation_hz[0] / speed_of_light_m_s +
                                                       phase_turns - reference_turns);
    z += 2.0 / sensor.taps * tap * std::polar(1.0, full_turn_rad * reference_turns);
  }
  return z;
}

} // namespace

Angles angles_of(const glm::dvec3 &direction, const Diode &diode) {
  const double along = glm::dot(direction, diode.axis), x = glm::dot(direction, diode.across);
  const double y = glm::dot(direction, glm::cross(diode.axis, diode.across));
  const double phi_rad = std::atan2(y, x);
  return {std::atan2(std::hypot(x, y), along), phi_rad < 0 ? phi_rad + full_turn_rad : phi_rad};
}

Illuminator light_at(const std::vector<glm::dvec3> &places_m, double phase_rad, const Pattern &pattern) {
  Illuminator illuminator{"light", Sensor().world_from_camera, {}, phase_rad};
  for (const glm::dvec3 &place_m : places_m)
    illuminator.diodes.emplace_back(diode_at(place_m)).pattern = pattern;
  return illuminator;
}

std::vector<glm::dvec3> ring(int count, double radius_m) {
  std::vector<glm::dvec3> places;
  for (int k = 0; k < count; ++k) {
    const double angle_rad = full_turn_rad * (k + 0.5) / count;
    places.emplace_back(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), 0.0);
  }
  return places;
}

Sensor wide_sensor() {
  Sensor sensor;
  sensor.resolution = {64, 48};
  sensor.pixel_pitch_m = glm::dvec2(0.018);
  sensor.focal_length_m = 1.0;
  return sensor;
}

std::vector<SimulatorOptions> all_variants() {
  std::vector<SimulatorOptions> variants;
  for (const auto loop : {DiodeLoop::straight_line, DiodeLoop::looped})
    for (const auto precision : {SamplePrecision::automatic, SamplePrecision::double_float})
      variants.push_back({.device = {}, .keep_taps = true, .precision = precision, .loop = loop});
  return variants;
}

Measurement measure(const WallCase &of, const SimulatorOptions &options) {
  std::vector<Illuminator> illuminators;
  for (const Light &light : of.lights)
    illuminators.push_back(light.illuminator);
  Simulator simulator = make_simulator(options);
  simulator.prepare(wall_at(of.wall_m, {reflectivity}), of.sensor, illuminators, of.backscatter);
  return simulator.measure();
}

Errors errors_of(const WallCase &of, const SimulatorOptions &options) {
  const Measurement measured = measure(of, options);
  const double ambiguity_m = of.sensor.ambiguity_m();
  Errors errors;
  for (std::size_t pixel = 0; pixel < of.sensor.pixel_count(); ++pixel) {
    const glm::dvec3 point_m = point_of(of.sensor, pixel, of.wall_m);
    if (of.left_out(point_m))
      continue;
    const auto z = return_of(paths_over(point_m, of.lights, of.backscatter), of.sensor);
    CHECK((measured.returns[0].amplitude[pixel] > 0) == (std::abs(z) > 0));
    if (std::abs(z) == 0)
      continue;
    ++errors.lit;
    const double distance_m = std::arg(z) / full_turn_rad * ambiguity_m;
    errors.distance_m =
        std::max(errors.distance_m,
                 std::abs(std::remainder(measured.returns[0].distance_m[pixel] - distance_m, ambiguity_m)));
    errors.amplitude =
        std::max(errors.amplitude, std::abs(measured.returns[0].amplitude[pixel] / std::abs(z) - 1.0));
  }
  return errors;
}

void check_wall(const WallCase &of, double amplitude_tolerance) {
  for (const SimulatorOptions &options : all_variants()) {
    const std::string name =
        fmt::format("{}, {}, {}", of.name, options.loop == DiodeLoop::looped ? "loop" : "straight",
                    options.precision == SamplePrecision::automatic ? "best precision" : "float pairs");
    const Errors errors = errors_of(of, options);
    fmt::print("{:<72}{:>6} lit{:>10.4f} um{:>12.2e}\n", name, errors.lit, 1e6 * errors.distance_m,
               errors.amplitude);
    INFO(name);
    CHECK(errors.lit > 100);
    CHECK(errors.distance_m <= 2e-6);
    CHECK(errors.amplitude <= amplitude_tolerance);
  }
}

} // namespace pmdsim::test
