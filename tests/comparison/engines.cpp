#include "tests/comparison/engines.h"

#include "engine/reference/reference.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim::test {

std::string name_of(Engine engine) { return engine == Engine::reference ? "reference" : "vulkan"; }

Engine both_engines() { return GENERATE(Engine::reference, Engine::vulkan); }

namespace {

void print_row(Engine engine, const std::string &name, double expected, double got, double error) {
  static const bool heading_printed = [] {
    fmt::print("{:<52}{:<12}{:>14}{:>14}{:>11}\n", "case (distances in m)", "engine", "expected", "got",
               "error");
    return true;
  }();
  static_cast<void>(heading_printed);
  fmt::print("{:<52}{:<12}{:>14.7g}{:>14.7g}{:>11.1e}\n", name, name_of(engine), expected, got, error);
}

} // namespace

Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor,
                    const std::vector<Illuminator> &illuminators, Backscatter backscatter,
                    const SimulatorOptions &options, Shadows shadows) {
  if (engine == Engine::reference) {
    const auto frame =
        reference::simulate(scene, sensor, illuminators, backscatter, {shadows, options.keep_visibility});
    Measurement measured = reference::to_measurement(frame);
    measured.sample_triangle_id = frame.sample_triangle_id;
    measured.sample_visibility = frame.sample_visibility;
    return measured;
  }
  Simulator simulator = make_simulator(options);
  simulator.prepare(scene, sensor, illuminators, backscatter, shadows);
  return simulator.measure();
}

Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor, const Illuminator &illuminator,
                    Backscatter backscatter, const SimulatorOptions &options, Shadows shadows) {
  return measure(engine, scene, sensor, std::vector{illuminator}, backscatter, options, shadows);
}

Measurement measure_monostatic(Engine engine, const Scene &scene, const Sensor &sensor,
                               Backscatter backscatter, const SimulatorOptions &options) {
  return measure(engine, scene, sensor, monostatic_illuminator(sensor.world_from_camera), backscatter,
                 options);
}

void check_distance(Engine engine, const std::string &name, double true_m, const Sensor &sensor, float got_m,
                    std::size_t frequency) {
  const double wrapped_m = std::fmod(true_m, sensor.ambiguity_m(frequency));
  const double error_m = std::remainder(got_m - wrapped_m, sensor.ambiguity_m(frequency));
  print_row(engine, name, wrapped_m, got_m, error_m);
  INFO(name << " on " << name_of(engine));
  CHECK(std::abs(error_m) <= std::max(2e-6, 1e-7 * true_m));
}

void check_amplitude(Engine engine, const std::string &name, double expected, double got) {
  print_row(engine, name, expected, got, got - expected);
  INFO(name << " on " << name_of(engine));
  CHECK(std::abs(got - expected) <= 1e-5 * expected);
}

void check_within(Engine engine, const std::string &name, double expected, double got, double tolerance) {
  print_row(engine, name, expected, got, got - expected);
  INFO(name << " on " << name_of(engine));
  CHECK(std::abs(got - expected) <= tolerance);
}

} // namespace pmdsim::test
