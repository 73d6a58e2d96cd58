#include "tests/analytic/engines.h"

#include "engine/reference/reference.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

namespace pmdsim::test {

namespace {

std::string name_of(Engine engine) { return engine == Engine::reference ? "reference" : "vulkan"; }

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

Measurement measure(Engine engine, const Scene &scene, const Sensor &sensor, const Illuminator &illuminator,
                    Backscatter backscatter) {
  if (engine == Engine::reference)
    return reference::to_measurement(reference::simulate(scene, sensor, illuminator, backscatter));
  Simulator simulator = make_simulator();
  simulator.prepare(scene, sensor, illuminator, backscatter);
  return simulator.measure();
}

void check_distance(Engine engine, const std::string &name, double true_m, const Sensor &sensor,
                    float got_m) {
  const double wrapped_m = std::fmod(true_m, sensor.ambiguity_m());
  const double error_m = std::remainder(got_m - wrapped_m, sensor.ambiguity_m());
  print_row(engine, name, wrapped_m, got_m, error_m);
  INFO(name << " on " << name_of(engine));
  CHECK(std::abs(error_m) <= std::max(2e-6, 1e-7 * true_m));
}

void check_amplitude(Engine engine, const std::string &name, double expected, double got) {
  print_row(engine, name, expected, got, got - expected);
  INFO(name << " on " << name_of(engine));
  CHECK(std::abs(got - expected) <= 1e-5 * expected);
}

} // namespace pmdsim::test
