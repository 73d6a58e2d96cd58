// The check before timing must fail for a device that computes something else.

#include "engine/model/error.h"
#include "host/bench/accuracy_check.h"
#include "host/capture/camera.h"
#include "tests/support/scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// The reference as truth, and the same rounded to float as what a sound device would give.
struct Frames {
  Sensor sensor = axial_sensor({4, 4});
  std::size_t diodes = 1;
  reference::Frame truth;
  Measurement found;

  explicit Frames(const Scene &scene = wall_at(2.0)) {
    truth = reference::simulate(scene, sensor, {monostatic_illuminator(sensor.world_from_camera)},
                                Backscatter::lambert);
    found = reference::to_measurement(truth);
    found.sample_triangle_id = truth.sample_triangle_id;
  }

  AccuracyCheck check(std::size_t frequency = 0) const {
    return compare(found, truth, sensor, frequency, diodes);
  }

  std::string failure() const {
    try {
      require_plausible(check(), "device");
    } catch (const Error &error) {
      CHECK(error.code() == ExitCode::internal);
      return error.what();
    }
    return "none";
  }
};

// 40 x 25 pixels of 2 x 2 samples, all of them lit by 40 diodes: 160,000 pairs.
struct ShadowedFrames : Frames {
  static constexpr std::size_t pairs = 160'000;

  ShadowedFrames() {
    diodes = 40;
    sensor = axial_sensor({40, 25});
    sensor.samples = 2;
    truth = reference::simulate(wall_at(2.0), sensor, {monostatic_illuminator(sensor.world_from_camera)},
                                Backscatter::lambert);
    truth.sample_visibility.assign(2 * truth.sample_triangle_id.size(), 0xffffffffu);
    for (std::size_t i = 1; i < truth.sample_visibility.size(); i += 2)
      truth.sample_visibility[i] = 0xffu; // diodes 32 to 39
    found = reference::to_measurement(truth);
    found.sample_triangle_id = truth.sample_triangle_id;
    found.sample_visibility = truth.sample_visibility;
  }

  // `diode` of a sample, counted through the frame, as the device sees it.
  void flip(std::size_t sample, std::size_t diode) {
    found.sample_visibility[2 * sample + diode / 32] ^= 1u << diode % 32;
  }
};

// Looks 85 degrees to either side of its axis.
Sensor fisheye_sensor(const glm::uvec2 &resolution) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.focal_length_m = 1e-3;
  sensor.pixel_pitch_m = 2.0 * glm::radians(85.0) * sensor.focal_length_m / glm::dvec2(resolution);
  sensor.distortion = Fisheye{};
  return sensor;
}

// A sensor that the reference cannot afford at all.
Sensor demanding(Sensor sensor) {
  sensor.samples = 16;
  sensor.taps = 16;
  sensor.waveform.kind = Waveform::Kind::square;
  sensor.modulation_hz.assign(16, 20e6);
  return sensor;
}

} // namespace

TEST_CASE("a device that rounds the reference to float passes") {
  const Frames frames;
  const AccuracyCheck check = frames.check();
  CHECK(check.comparable == 16);
  CHECK(check.pixels == 16);
  CHECK(check.not_finite == 0);
  CHECK(check.distance_max_m < 1e-6);
  CHECK(frames.failure() == "none");
}

TEST_CASE("a distance that is too far off fails") {
  Frames frames;
  frames.found.returns[0].distance_m[5] += 0.001F;
  CHECK(frames.check().distance_max_m == Approx(0.001).epsilon(1e-3));
  CHECK(frames.failure().starts_with(
      "device: sensor pmd at 20 MHz: distances differ from the reference by up to "));
}

TEST_CASE("an error that is claimed is plausible, a larger one is not") {
  Frames frames;
  frames.found.accuracy.claimed_m = 0.002;
  frames.found.returns[0].distance_m[5] += 0.001F;
  CHECK(frames.check().claimed_m == 0.002);
  CHECK(frames.failure() == "none");
  frames.found.returns[0].distance_m[5] += 0.002F;
  CHECK(frames.failure().find("expected at most 2.01 mm") != std::string::npos);
}

TEST_CASE("a distance that is not finite fails, be it one or all") {
  const float value = GENERATE(as<float>{}, not_a_number, std::numeric_limits<float>::infinity());
  Frames frames;
  frames.found.returns[0].distance_m[7] = value;
  CHECK(frames.failure() ==
        "device: sensor pmd at 20 MHz: distances are not finite in 1 of 16 pixels where the reference's are");
  std::ranges::fill(frames.found.returns[0].distance_m, value);
  CHECK(
      frames.failure() ==
      "device: sensor pmd at 20 MHz: distances are not finite in 16 of 16 pixels where the reference's are");
}

TEST_CASE("other triangles are forgiven in half of the pixels") {
  Frames frames;
  std::fill_n(frames.found.sample_triangle_id.begin(), 8, no_id);
  std::fill_n(frames.found.returns[0].distance_m.begin(), 8, not_a_number);
  CHECK(frames.failure() == "none");
  frames.found.sample_triangle_id[8] = no_id;
  CHECK(frames.failure() == "device: sensor pmd at 20 MHz: sees the reference's triangles in 7 of 16 pixels; "
                            "expected at least half");
}

TEST_CASE("pixels that other diodes reach are left out") {
  ShadowedFrames frames;
  frames.flip(7 * 80 + 15, 39); // of pixel (7, 3)
  frames.flip(7 * 80 + 15, 3);
  frames.found.returns[0].distance_m[3 * 40 + 7] += 0.001F;
  const AccuracyCheck check = frames.check();
  CHECK(check.pairs == ShadowedFrames::pairs);
  CHECK(check.pairs_apart == 2);
  CHECK(check.comparable == 1000);
  CHECK(check.same_triangles == 1000);
  CHECK(check.pixels == 999);
  CHECK(check.distance_max_m < 1e-6);
  CHECK(frames.failure() == "none");
  frames.found.returns[0].distance_m[3 * 40 + 8] += 0.001F;
  CHECK(frames.check().distance_max_m == Approx(0.001).epsilon(1e-3));
}

TEST_CASE("other diodes are forgiven in a thousandth of the pairs, in dark pixels too") {
  ShadowedFrames frames;
  std::ranges::fill(frames.truth.returns[0].amplitude, 0.0);
  for (std::size_t sample = 0; sample < 160; ++sample)
    frames.flip(sample, sample % 40);
  CHECK(frames.failure() == "none");
  frames.flip(160, 0);
  CHECK(frames.failure() == "device: sensor pmd at 20 MHz: 161 of 160000 pairs of sample and diode are lit "
                            "where the reference's are not, or the other way round; expected at most 160");
}

TEST_CASE("in a small frame the edge of a shadow may run through a line of pixels") {
  Frames frames;
  frames.truth.sample_visibility.assign(16, 1);
  frames.found.sample_visibility = frames.truth.sample_visibility;
  for (std::size_t row = 0; row < 4; ++row)
    frames.found.sample_visibility[4 * row + 1] = 0;
  CHECK(frames.check().pairs_apart == 4);
  CHECK(frames.check().pixels == 12);
  CHECK(frames.failure() == "none");
  frames.found.sample_visibility[0] = 0;
  CHECK(frames.failure().find("5 of 16 pairs") != std::string::npos);
}

TEST_CASE("which diodes reach another triangle, or nothing, is not compared") {
  ShadowedFrames frames;
  for (std::size_t sample = 0; sample < 1000; ++sample) {
    frames.found.sample_triangle_id[sample] = no_id;
    frames.flip(sample, 0);
  }
  for (std::size_t sample = 1000; sample < 2000; ++sample) {
    frames.found.sample_triangle_id[sample] = frames.truth.sample_triangle_id[sample] = no_id;
    frames.flip(sample, 1);
  }
  CHECK(frames.check().pairs == ShadowedFrames::pairs / 2);
  CHECK(frames.check().pairs_apart == 0);
  CHECK(frames.failure() == "none");
}

TEST_CASE("a device that does not tell which diodes reach a sample is not compared") {
  ShadowedFrames frames;
  frames.found.sample_visibility.clear();
  CHECK_THROWS_WITH(frames.check(), "the device and the reference do not tell of the same samples");
}

TEST_CASE("where the reference is dark there is nothing to compare and nothing fails") {
  const Frames frames(wall_at(-2.0));
  CHECK(frames.check().comparable == 0);
  CHECK(frames.failure() == "none");
}

TEST_CASE("every frequency is compared by its own ambiguity range") {
  Frames frames;
  frames.sensor.modulation_hz = {20e6, 50e6};
  frames.truth.returns.push_back(frames.truth.returns[0]);
  frames.found.returns.push_back(frames.found.returns[0]);
  const auto range_m = static_cast<float>(frames.sensor.ambiguity_m(1));
  for (float &distance_m : frames.found.returns[1].distance_m)
    distance_m += range_m; // the same place, a turn later
  frames.found.returns[1].distance_m[3] += 0.001F;
  CHECK(frames.check(0).distance_max_m < 1e-6);
  CHECK(frames.check(1).distance_max_m == Approx(0.001).epsilon(1e-3));
  CHECK(frames.check(1).modulation_hz == 50e6);
}

TEST_CASE("where the taps cancel there is nothing to compare") {
  Frames frames;
  frames.truth.returns[0].taps = {std::vector<double>(16, 1e4 * frames.truth.returns[0].amplitude[0])};
  CHECK(frames.check().comparable == 0);
}

TEST_CASE("a wide sensor stays fine enough for the device, however dear the reference is") {
  const glm::uvec2 resolution = GENERATE(glm::uvec2(640, 480), glm::uvec2(8192, 64), glm::uvec2(9, 640));
  const Sensor fine = demanding(fisheye_sensor(resolution));
  for (const std::size_t diodes : {1u, 1000u, 100'000u})
    for (const std::size_t sensors : {1u, 64u}) {
      const Sensor sensor = affordable(fine, diodes, Shadows::off, sensors);
      INFO(diodes << " diodes, " << sensors << " sensors: " << sensor.resolution.x << " x "
                  << sensor.resolution.y);
      CHECK(sensor.resolution.x >= 8);
      CHECK(sensor.resolution.y >= 8);
      const glm::dvec2 chip_m = glm::dvec2(fine.resolution) * fine.pixel_pitch_m;
      const glm::dvec2 coarse_chip_m = glm::dvec2(sensor.resolution) * sensor.pixel_pitch_m;
      CHECK(glm::distance(chip_m, coarse_chip_m) < 1e-12 * glm::length(chip_m));
    }
  const Sensor coarsest = affordable(fine, 100'000, Shadows::off, 64);
  CHECK(coarsest.samples == 1);
  const Scene scene = wall_at(2.0);
  Camera camera("");
  camera.prepare(scene, coarsest, {monostatic_illuminator(coarsest.world_from_camera)}, Backscatter::lambert,
                 Shadows::off);
  CHECK_NOTHROW(camera.measure());
}

TEST_CASE("a sensor with fewer pixels than are left of others keeps them all") {
  const Sensor sensor = affordable(demanding(fisheye_sensor({5, 640})), 100'000, Shadows::automatic, 64);
  CHECK(sensor.resolution == glm::uvec2(5, 8));
  CHECK(sensor.samples == 1);
}

TEST_CASE("samples are given up only where fewer pixels do not help") {
  Sensor sensor = fisheye_sensor({640, 480});
  sensor.samples = 4;
  CHECK(affordable(sensor, 1, Shadows::off, 1).resolution == sensor.resolution);
  const Sensor coarse = affordable(sensor, 1000, Shadows::off, 1);
  CHECK(coarse.samples == 4);
  CHECK(coarse.resolution.x < 640);
  CHECK(coarse.pixel_count() * 16 * 1000 <= 200'000'000);
}

TEST_CASE("shadows leave fewer pixels to be checked") {
  const Sensor fine = fisheye_sensor({640, 480});
  const Sensor without = affordable(fine, 240, Shadows::off, 1);
  const Sensor with = affordable(fine, 240, Shadows::automatic, 1);
  CHECK(without.resolution == fine.resolution);
  CHECK(with.pixel_count() * 240 < 200'000'000 / 6 + 1);
  CHECK(with.pixel_count() * 240 > 200'000'000 / 7);
}
