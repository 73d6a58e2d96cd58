// How a frame is made of exposures, with motion and without.

#include "engine/model/tap_sequence.h"
#include "host/capture/exposure.h"
#include "host/input/setup/parts.h"
#include "tests/program/program.h"
#include "tests/support/scenes.h"

#include <catch2/catch.hpp>
#include <complex>
#include <numbers>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

Sensor two_frequencies() {
  Sensor sensor = axial_sensor();
  sensor.modulation_hz = {20e6, 30e6};
  sensor.taps = 3;
  sensor.tap_interval_s = 1e-3;
  return sensor;
}

// A measurement of one pixel; `number` tells it from others.
Measurement exposure_number(float number, std::uint32_t taps) {
  Measurement measurement;
  measurement.range_m = {number};
  measurement.lit = {0.1f * number};
  Return of_frequency;
  for (std::uint32_t k = 0; k < taps; ++k)
    of_frequency.taps.push_back({10.0f * number + static_cast<float>(k)});
  measurement.returns = {of_frequency};
  measurement.frame_ms = 2.0;
  measurement.passes = {{"points", 0.5}, {"accumulate", 1.5}};
  return measurement;
}

void no_progress(double) {}

// The motion of a setup in which nothing moves.
std::shared_ptr<const Motion> at_rest(const std::string &scene, const Setup &setup) {
  const GltfFile gltf = load_gltf(scene, {setup.file});
  return std::make_shared<const Motion>([gltf](double time_s) { return gltf.at(time_s); }, Trajectories{},
                                        setup.as_used, Place{setup.file});
}

// A wall at rest, loaded from files; `moving` makes the program think that it moves.
struct LoadedWall {
  Workspace work;
  Setup setup;

  LoadedWall(double tap_interval_s, bool moving) {
    work.write("wall.gltf", wall_gltf());
    setup = load_setup(work.write("setup.json", with(small_setup(), "[20e6]", "[20e6, 30e6]")));
    setup.start.sensors[0].tap_interval_s = tap_interval_s;
    if (moving)
      setup.motion = at_rest(work / "wall.gltf", setup);
  }
};

} // namespace

TEST_CASE("frequency by frequency and tap by tap, at ascending times") {
  const Sensor sensor = two_frequencies();
  std::vector<std::pair<std::size_t, double>> taken;
  const Measurement frame = measure_tap_by_tap(sensor, 5.0, [&](std::size_t frequency, double time_s) {
    taken.emplace_back(frequency, time_s);
    return exposure_number(static_cast<float>(taken.size()), sensor.taps);
  });
  REQUIRE(taken.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(taken[i].first == i / 3);
    CHECK(taken[i].second == Approx(5.0 + 1e-3 * static_cast<double>(i)).epsilon(1e-12));
  }
  REQUIRE(frame.returns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(frame.returns[i].taps[k][0] == static_cast<float>(10 * (3 * i + k + 1) + k));
  CHECK(frame.range_m == std::vector<float>{1.0f});
  CHECK(frame.lit == std::vector<float>{0.1f});
  CHECK(frame.frame_ms == Approx(12.0));
  REQUIRE(frame.passes.size() == 2);
  CHECK(frame.passes[0].name == "points");
  CHECK(frame.passes[1].ms == Approx(9.0));
}

TEST_CASE("a wall that moves away reads what the closed form says") {
  const std::string device = GENERATE(as<std::string>{}, "", "reference");
  constexpr double start_m = 1.5, speed_m_s = 1.0;
  const Sensor sensor = two_frequencies();
  Camera camera(device, {.taps = true});
  Scene scene;
  const Measurement frame = measure_tap_by_tap(sensor, 0.0, [&](std::size_t frequency, double time_s) {
    Sensor alone = sensor;
    alone.modulation_hz = {sensor.modulation_hz[frequency]};
    scene = wall_at(start_m + speed_m_s * time_s);
    camera.prepare(scene, alone, {monostatic_illuminator(sensor.world_from_camera)}, Backscatter::constant,
                   Shadows::off);
    return camera.measure();
  });
  CHECK(frame.range_m[0] == Approx(start_m));
  for (std::size_t i = 0; i < 2; ++i) {
    // Monostatic light of 1 W/sr on a wall of reflectivity 1: |z| = 1 / r^2 and phase = 2 r * 2 pi f / c.
    std::complex<double> z = 0.0;
    for (std::uint32_t k = 0; k < sensor.taps; ++k) {
      const double range_m = start_m + speed_m_s * tap_time_s(sensor, 0.0, i, k);
      const double reference_rad = 2.0 * std::numbers::pi * k / sensor.taps;
      const double phase_rad = 2.0 * std::numbers::pi * range_m / sensor.ambiguity_m(i);
      z += 2.0 / sensor.taps / (range_m * range_m) * std::cos(phase_rad - reference_rad) *
           std::polar(1.0, reference_rad);
    }
    const double phase_rad = std::arg(z) + (std::arg(z) < 0.0 ? 2.0 * std::numbers::pi : 0.0);
    const double distance_m = sensor.ambiguity_m(i) * phase_rad / (2.0 * std::numbers::pi);
    INFO(camera.device() << ", frequency " << i);
    CHECK(frame.returns[i].distance_m[0] == Approx(distance_m).margin(2e-6));
    CHECK(frame.returns[i].amplitude[0] == Approx(std::abs(z)).epsilon(1e-5));
    // The wall has moved by some millimetres since the frame began, and it shows.
    CHECK(frame.returns[i].distance_m[0] > start_m + 1e-4);
  }
}

TEST_CASE("tap by tap, a scene at rest measures what one exposure does") {
  const std::string device = GENERATE(as<std::string>{}, "", "reference");
  const Light light = GENERATE(Light::beside_lens, Light::in_lens);
  const LoadedWall at_once(0.0, true), in_sequence(1e-3, true);
  CHECK_FALSE(exposes_tap_by_tap(at_once.setup, at_once.setup.start.sensors[0]));
  CHECK(exposes_tap_by_tap(in_sequence.setup, in_sequence.setup.start.sensors[0]));
  const Measurement expected =
      Exposures(at_once.setup, device, true).take(0, 0.0, light, no_progress).measurement;
  const Measurement found =
      Exposures(in_sequence.setup, device, true).take(0, 0.0, light, no_progress).measurement;
  CHECK(found.range_m == expected.range_m);
  CHECK(found.object_id == expected.object_id);
  REQUIRE(found.returns.size() == 2);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t pixel = 0; pixel < expected.range_m.size(); ++pixel) {
      CHECK(found.returns[i].distance_m[pixel] == Approx(expected.returns[i].distance_m[pixel]).margin(2e-6));
      CHECK(found.returns[i].taps[2][pixel] == Approx(expected.returns[i].taps[2][pixel]).epsilon(1e-5));
    }
}

TEST_CASE("tap by tap frames are taken in mode exact whatever is asked for") {
  const LoadedWall at_once(1e-3, false), in_sequence(1e-3, true);
  const auto mode_of = [](const Setup &setup, Mode mode) {
    Accuracy accuracy;
    accuracy.mode = mode;
    return Exposures(setup, "", false, accuracy).take(0, 0.0, Light::beside_lens, no_progress).mode;
  };
  CHECK(mode_of(at_once.setup, Mode::automatic) == Mode::automatic);
  CHECK(mode_of(at_once.setup, Mode::exact) == Mode::exact);
  CHECK(mode_of(in_sequence.setup, Mode::automatic) == Mode::exact);
}

TEST_CASE("the setup's light casts its shadows, light in the lens none") {
  const std::string device = GENERATE(as<std::string>{}, "", "reference");
  LoadedWall wall(1e-3, GENERATE(false, true));
  const auto lit = [&](Light light) {
    return Exposures(wall.setup, device, false).take(0, 0.0, light, no_progress).measurement.lit;
  };
  CHECK(lit(Light::beside_lens) == std::vector(64, 1.0f));
  CHECK(lit(Light::in_lens).empty());
  wall.setup.shadows = Shadows::off;
  CHECK(lit(Light::beside_lens).empty());
}

TEST_CASE("where light bounces, that in the lens casts shadows as the setup has them") {
  LoadedWall wall(0.0, false);
  wall.setup.backscatter = Backscatter::lambert;
  wall.setup.bounces.count = 1;
  const auto lit = [&] {
    return Exposures(wall.setup, "", false).take(0, 0.0, Light::in_lens, no_progress).measurement.lit;
  };
  CHECK(lit() == std::vector(64, 1.0f));
  wall.setup.shadows = Shadows::off;
  CHECK(lit().empty());
}

TEST_CASE("where nothing moves, one exposure serves all taps") {
  const LoadedWall still(1e-3, false);
  CHECK_FALSE(exposes_tap_by_tap(still.setup, still.setup.start.sensors[0]));
  CHECK(samples_of_frame(still.setup) == 64.0);
  CHECK(samples_of_frame(LoadedWall(1e-3, true).setup) == 2.0 * 4.0 * 64.0);
}

TEST_CASE("progress runs once over all exposures of a frame") {
  const LoadedWall wall(1e-3, true);
  std::vector<double> fractions;
  Exposures exposures(wall.setup, "reference", false);
  const TakenFrame frame =
      exposures.take(0, 0.0, Light::beside_lens, [&](double fraction) { fractions.push_back(fraction); });
  CHECK(std::is_sorted(fractions.begin(), fractions.end()));
  CHECK(fractions.front() < 0.2);
  CHECK(fractions.back() == 1.0);
  CHECK(frame.measurement.returns[0].taps.empty());
  CHECK(frame.sensor.modulation_hz.size() == 2);
}

TEST_CASE("a frame knows its sensor and its number") {
  for (const bool tap_by_tap : {false, true}) {
    const LoadedWall wall(tap_by_tap ? 1e-3 : 0.0, tap_by_tap);
    Exposures exposures(wall.setup, "reference", false);
    const TakenFrame frame = exposures.take(0, 3, Light::beside_lens, no_progress);
    CHECK(frame.measurement.number == ExposureNumber{0, 3, 0});
  }
}

TEST_CASE("scatter and electrons of taps that are exposed one by one are those of one exposure, at rest") {
  const auto taken = [](bool one_by_one) {
    LoadedWall wall(one_by_one ? 1e-3 : 0.0, one_by_one);
    Sensor &sensor = wall.setup.start.sensors[0];
    sensor.scatter = {{0.2, 2.0 * sensor.pixel_pitch_m.x}};
    sensor.electronics.emplace();
    sensor.electronics->full_well_e = 1e9;
    sensor.electronics->read_noise_e = 20.0;
    sensor.electronics->noiseless_channels = true;
    sensor.electronics->gain_dn_per_e = 1e-4;
    Exposures exposures(wall.setup, "", true);
    return exposures.take(0, 0, Light::beside_lens, no_progress).measurement;
  };
  const Measurement at_once = taken(false), one_by_one = taken(true);
  for (const Measurement *frame : {&at_once, &one_by_one})
    CHECK(std::ranges::count(frame->passes, "scatter", &PassTime::name) == 1);
  for (std::size_t f = 0; f < 2; ++f)
    for (std::size_t i = 0; i < at_once.coverage.size(); ++i) {
      const Return &a = at_once.returns[f], &b = one_by_one.returns[f];
      CHECK(b.amplitude_noiseless[i] == Approx(a.amplitude_noiseless[i]).epsilon(1e-5));
      CHECK(b.phase_rad_noiseless[i] == Approx(a.phase_rad_noiseless[i]).margin(1e-5));
      CHECK(b.tap_a_e[1][i] == Approx(a.tap_a_e[1][i]).epsilon(1e-5));
      CHECK(one_by_one.mean_radiance[i] == Approx(at_once.mean_radiance[i]).epsilon(1e-5));
    }
}

TEST_CASE("another camera of the same frequency is an illuminator more, at once and tap by tap") {
  const auto taken = [](bool is_another, bool one_by_one) {
    Workspace work;
    work.write("wall.gltf", wall_gltf());
    auto json = nlohmann::json::parse(small_setup());
    auto lamp = json["illuminators"][0];
    lamp["name"] = "other";
    lamp["pose"] = {{"position_m", {0.3, 0.1, 0.0}}, {"look_at_m", {0.0, 0.0, -1.0}}};
    lamp["modulation_phase_deg"] = 50;
    if (is_another)
      lamp["modulation_hz"] = json["sensors"][0]["modulation_hz"][0];
    json["illuminators"].insert(json["illuminators"].begin(), lamp);
    Setup setup = load_setup(work.write("setup.json", json.dump()));
    Sensor &sensor = setup.start.sensors[0];
    sensor.tap_interval_s = one_by_one ? 1e-3 : 0.0;
    sensor.electronics.emplace();
    sensor.electronics->full_well_e = 1e9;
    sensor.electronics->read_noise_e = 20.0;
    sensor.electronics->gain_dn_per_e = 1e-4;
    if (one_by_one)
      setup.motion = at_rest(work / "wall.gltf", setup);
    Exposures exposures(setup, "", true);
    return exposures.take(0, 0, Light::beside_lens, no_progress).measurement;
  };
  const Measurement own = taken(false, false);
  for (const bool one_by_one : {false, true}) {
    const Measurement other = taken(true, one_by_one);
    for (std::size_t i = 0; i < own.coverage.size(); ++i) {
      CHECK(other.mean_radiance[i] == Approx(own.mean_radiance[i]).epsilon(1e-6));
      for (std::size_t k = 0; k < own.returns[0].taps.size(); ++k) {
        CHECK(other.returns[0].tap_a_e[k][i] == Approx(own.returns[0].tap_a_e[k][i]).epsilon(1e-5));
        CHECK(other.returns[0].tap_b_e[k][i] == Approx(own.returns[0].tap_b_e[k][i]).epsilon(1e-5));
      }
    }
  }
}
