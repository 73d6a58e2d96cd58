// The way from radiance to electrons beside numbers computed by hand.

#include "engine/electronics/photon_chain.h"
#include "tests/electronics/fixture.h"

#include <catch2/catch.hpp>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// f/1.5, T = 0.9, 1 ms, 850 nm, quantum efficiency 0.5, pixels of 10 um.
Sensor plain_sensor() {
  Sensor sensor;
  sensor.pixel_pitch_m = {10e-6, 10e-6};
  sensor.electronics = plain_electronics();
  sensor.electronics->wavelength_m = 850e-9;
  return sensor;
}

} // namespace

TEST_CASE("one watt per square metre and steradian is so many photons and electrons of a pixel") {
  const Sensor sensor = plain_sensor();
  // pi 0.9 / (4 1.5^2) = pi / 10.
  CHECK(irradiance_w_m2(1.0, *sensor.electronics) == Approx(0.3141592654).epsilon(1e-9));
  // 1e-13 m^2 s of it is 3.1416e-14 J, of photons of 2.33699e-19 J each.
  CHECK(photons(0.3141592654, sensor) == Approx(134428.72).epsilon(1e-6));
  CHECK(electrons(134428.72, *sensor.electronics) == Approx(67214.36));
  CHECK(electrons_of(2.0, sensor) == Approx(134428.72).epsilon(1e-6));
}

TEST_CASE("a pixel counts the light of its active area, and a part that is averaged that of its own") {
  Sensor sensor = plain_sensor();
  sensor.fill_factor = {0.5, 0.8};
  CHECK(electrons_of(1.0, sensor) == Approx(0.4 * 67214.36).epsilon(1e-6));
  sensor.electronics->parts_averaged = 4;
  CHECK(electrons_of(1.0, sensor) == Approx(0.1 * 67214.36).epsilon(1e-6));
}

TEST_CASE("two taps share an image's electrons, and differ by contrast times correlation") {
  const TapElectrons taps = tap_electrons({6000.0, 1000.0, 200.0}, -4000.0, 0.6);
  CHECK(taps.a_e == Approx(3600.0 - 1200.0));
  CHECK(taps.b_e == Approx(3600.0 + 1200.0));
}
