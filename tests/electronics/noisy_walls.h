#pragma once
// Two walls before a small sensor with electronics, as a simulator measures them.

#include "engine/electronics/electrons.h"
#include "tests/electronics/fixture.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

namespace pmdsim::test {

inline Scene two_walls() {
  SceneBuilder builder;
  builder.add_wall({1.7, {.reflectivity = 0.6}, {-2.0, -2.0}, {0.05, 2.0}});
  builder.add_wall({2.4, {.reflectivity = 0.2}, {0.05, -2.0}, {2.0, 2.0}});
  return builder.scene();
}

inline Sensor noisy_sensor() {
  Sensor sensor;
  sensor.resolution = {67, 45};
  sensor.pixel_pitch_m = {15e-6, 15e-6};
  sensor.focal_length_m = 0.002;
  sensor.modulation_hz = {20e6, 80e6};
  sensor.electronics = plain_electronics();
  sensor.electronics->dsnu_e = 30.0;
  sensor.electronics->prnu = 0.01;
  return sensor;
}

inline std::vector<Illuminator> two_lights(const Sensor &sensor) {
  Illuminator first = diode_beside_lens(sensor, diode_at({0.03, 0.0, 0.0})),
              second = diode_beside_lens(sensor, diode_at({-0.04, 0.02, 0.0}));
  first.diodes[0].intensity_w_sr = 0.4;
  first.modulation_depth = 0.8;
  second.diodes[0].intensity_w_sr = 0.2;
  second.modulation_depth = 0.5;
  second.modulation_phase_rad = 0.6;
  return {first, second};
}

// Of a picture: each pixel's own part of 20 mW/(m^2 sr).
inline void give_uneven_background(Electronics &electronics, std::size_t pixels) {
  electronics.background_radiance_w_m2_sr = 0.02;
  for (std::size_t i = 0; i < pixels; ++i)
    electronics.background_image.push_back(static_cast<float>(i % 101) / 100.0f);
}

inline Measurement measured(const Sensor &sensor, const SimulatorOptions &options = {},
                            std::uint32_t frame = 7) {
  Simulator simulator = make_simulator(options);
  simulator.prepare(two_walls(), sensor, two_lights(sensor), Backscatter::lambert, Shadows::automatic);
  Measurement measurement = simulator.measure({}, {2, frame, 0});
  CHECK(measurement.has_electrons == (options.count_electrons && counts_by_strips(sensor)));
  if (!measurement.has_electrons)
    count_electrons(sensor, {.keep_taps = true, .host_vector_bits = options.host_vector_bits}, measurement);
  return measurement;
}

} // namespace pmdsim::test
