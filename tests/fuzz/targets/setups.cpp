// Valid but extreme setups, decoded from bytes: the device's frame in mode auto against the reference's,
// within the error that was asked for, or refused. A setup's shaders take seconds to compile, so that each is
// measured again with other numbers, which need the same ones.

#include "tests/fuzz/target.h"

#include "engine/lens/lens.h"
#include "tests/comparison/comparison.h"
#include "tests/fuzz/decoder.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"
#include "tests/whole/uncertain_pixels.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string_view>

using namespace pmdsim;
using test::RandomSetup;

namespace {

constexpr double half_turn_rad = std::numbers::pi;
#ifdef PMDSIM_FUZZ
constexpr unsigned turns = 15;
#else
constexpr unsigned turns = 1; // every day
#endif

glm::dvec3 any_vector(fuzz::Decoder &bytes, double reach) {
  const double x = bytes.uniform(-reach, reach), y = bytes.uniform(-reach, reach);
  return {x, y, bytes.uniform(-reach, reach)};
}

Pose any_pose(fuzz::Decoder &bytes) {
  if (!bytes.flag())
    return node_from_camera();
  const double angle_rad = bytes.uniform(-half_turn_rad, half_turn_rad),
               reach_m = bytes.log_uniform(1e-3, 1e6);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {glm::dmat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0) * node_from_camera().rotation,
          any_vector(bytes, reach_m)};
}

Distortion any_distortion(fuzz::Decoder &bytes, double radius) {
  const auto relative = [&](double power) { return bytes.uniform(-0.4, 0.4) / std::pow(radius, power); };
  const std::size_t kind = bytes.below(4);
  if (kind < 2)
    return {};
  const double a = relative(2), b = relative(4), c = relative(6), d = relative(1), e = relative(1);
  if (kind == 2)
    return BrownConrady{a, b, 0.2 * d, 0.2 * e, c};
  return Fisheye{a, b, c, relative(8)};
}

Waveform any_waveform(fuzz::Decoder &bytes) {
  constexpr std::array kinds{Waveform::Kind::sine, Waveform::Kind::sine, Waveform::Kind::square,
                             Waveform::Kind::harmonics};
  Waveform waveform{bytes.one_of(kinds), {}};
  if (waveform.kind == Waveform::Kind::harmonics)
    waveform.harmonics = {1.0, bytes.uniform(-0.3, 0.3), bytes.uniform(-0.2, 0.2)};
  return waveform;
}

// 16 x 16 pixels, or fewer.
Sensor any_sensor(fuzz::Decoder &bytes) {
  Sensor sensor;
  sensor.resolution = {1 + bytes.below(16), 1 + bytes.below(16)};
  sensor.focal_length_m = bytes.log_uniform(1e-4, 1.0);
  const double half_image = bytes.log_uniform(1e-3, 4.0); // over the focal length
  sensor.pixel_pitch_m = 2.0 * half_image * sensor.focal_length_m / glm::dvec2(sensor.resolution);
  sensor.distortion = any_distortion(bytes, half_image);
  sensor.dark_beyond_fold = bytes.flag();
  if (bytes.flag())
    sensor.chip = {any_vector(bytes, 0.3), any_vector(bytes, 0.1 * sensor.focal_length_m)};
  if (bytes.flag())
    sensor.fill_factor = {bytes.uniform(0.01, 1.0), bytes.uniform(0.01, 1.0)};
  sensor.vignetting = bytes.flag() ? Vignetting::cos4 : Vignetting::none;
  sensor.world_from_camera = any_pose(bytes);
  sensor.modulation_hz.assign(1 + bytes.below(3), 20e6);
  for (double &modulation_hz : sensor.modulation_hz)
    modulation_hz = bytes.log_uniform(1e3, 1e10);
  sensor.waveform = any_waveform(bytes);
  sensor.taps = static_cast<std::uint32_t>(3 + bytes.below(4));
  sensor.samples = static_cast<std::uint32_t>(1 + bytes.below(4));
  sensor.adaptive_samples = sensor.samples > 1 && bytes.flag();
  return sensor;
}

// Large and small triangles in front of the lens, some without an area.
Scene any_scene(fuzz::Decoder &bytes, const Sensor &sensor) {
  test::SceneBuilder builder(sensor.world_from_camera);
  const double distance_m = bytes.log_uniform(1e-3, 1e5);
  for (std::size_t left = bytes.below(8); left > 0; --left) {
    const double size_m = distance_m * bytes.log_uniform(1e-5, 100.0), aspect = bytes.log_uniform(1e-6, 1.0);
    const Surface surface{bytes.uniform(0.0, 1.0), bytes.flag()};
    const glm::dvec3 corner_m = distance_m * (glm::dvec3(0.0, 0.0, 1.0) + any_vector(bytes, 0.8));
    const glm::dvec3 u_m = any_vector(bytes, size_m),
                     v_m = bytes.below(16) == 15 ? u_m : aspect * any_vector(bytes, size_m);
    builder.add_triangle(corner_m, corner_m + u_m, corner_m + v_m, surface);
  }
  if (bytes.flag()) {
    const double half_m = distance_m * bytes.log_uniform(0.1, 100.0);
    builder.add_wall(
        {distance_m, {bytes.uniform(0.0, 1.0), bytes.flag()}, glm::dvec2(-half_m), glm::dvec2(half_m)});
  }
  return builder.scene();
}

Pattern any_pattern(fuzz::Decoder &bytes) {
  return bytes.flag() ? Pattern{}
                      : Pattern{Pattern::Kind::cosine,
                                bytes.flag() ? double(bytes.below(9)) : bytes.log_uniform(0.3, 300.0)};
}

Illuminator any_light(fuzz::Decoder &bytes, const Sensor &sensor) {
  Illuminator light{
      "light",
      compose(sensor.world_from_camera, {glm::dmat3(1.0), any_vector(bytes, bytes.log_uniform(1e-4, 10.0))}),
      {}};
  const double reach_m = bytes.log_uniform(1e-4, 10.0), intensity_w_sr = bytes.log_uniform(1e-12, 1e12);
  const bool is_tilted = bytes.flag(), is_unequal = bytes.flag();
  Pattern pattern = any_pattern(bytes);
  const bool is_mixed = bytes.flag();
  for (std::size_t left = 1 + bytes.below(bytes.flag() ? 12 : 200); left > 0; --left) {
    Diode diode = test::diode_at(any_vector(bytes, reach_m));
    if (is_tilted)
      diode.axis = glm::normalize(glm::dvec3(0.0, 0.0, 1.2) + any_vector(bytes, 0.6));
    diode.across = glm::normalize(glm::cross(diode.axis, glm::dvec3(0.0, 1.0, 0.0)));
    diode.intensity_w_sr = intensity_w_sr * (is_unequal ? bytes.uniform(0.0, 2.0) : 1.0);
    diode.pattern = pattern = is_mixed ? any_pattern(bytes) : pattern;
    light.diodes.push_back(diode);
  }
  light.modulation_phase_rad = bytes.flag() ? bytes.uniform(-half_turn_rad, half_turn_rad) : 0.0;
  return light;
}

RandomSetup any_setup(fuzz::Decoder &bytes) {
  RandomSetup setup;
  setup.backscatter = bytes.flag() ? Backscatter::constant : Backscatter::lambert;
  setup.shadows = bytes.flag() ? Shadows::automatic : Shadows::off;
  setup.max_error_m = bytes.log_uniform(1e-6, 1e-1);
  setup.sensor = any_sensor(bytes);
  setup.scene = any_scene(bytes, setup.sensor);
  for (std::size_t left = 1 + bytes.below(2); left > 0; --left)
    setup.illuminators.push_back(any_light(bytes, setup.sensor));
  return setup;
}

// Other places, frequencies, intensities and another error; what there is stays.
void vary(RandomSetup &setup, test::Random &random) {
  const glm::dvec3 lens_m = setup.sensor.world_from_camera.translation_m;
  const double nearness = random.log_uniform(0.2, 5.0), shake = random.log_uniform(1e-6, 0.1);
  for (glm::dvec3 &position_m : setup.scene.positions_m)
    position_m = lens_m + nearness * random.in_box(glm::dvec3(1.0 - shake), glm::dvec3(1.0 + shake)) *
                              (position_m - lens_m);
  const double spread = random.log_uniform(0.1, 10.0), strength = random.log_uniform(0.1, 10.0);
  for (Illuminator &light : setup.illuminators)
    for (Diode &diode : light.diodes) {
      diode.position_m *= spread;
      diode.intensity_w_sr *= strength * random.uniform(0.9, 1.1);
    }
  for (double &modulation_hz : setup.sensor.modulation_hz)
    modulation_hz = std::clamp(modulation_hz * random.log_uniform(0.3, 3.0), 1e3, 1e10);
  setup.max_error_m = random.log_uniform(1e-6, 1e-1);
}

Accuracy within_budget(const RandomSetup &setup) {
  return {.mode = Mode::automatic, .precision = {}, .max_error_m = setup.max_error_m, .strict = true};
}

void require(bool holds, const char *what, double found, const RandomSetup &setup) {
  if (holds)
    return;
  std::fprintf(stderr, "%s: %g, where %g m were asked for\n", what, found, setup.max_error_m);
  std::abort();
}

void compare_with_reference(const RandomSetup &setup, const Measurement &measured) {
  const bool shadows = setup.shadows == Shadows::automatic;
  const auto expected = reference::simulate(setup.scene, setup.sensor, setup.illuminators, setup.backscatter,
                                            {.shadows = setup.shadows, .keep_visibility = shadows});
  const test::Comparison comparison = test::compare(measured, expected, setup.scene, setup.sensor,
                                                    test::uncertain_pixels(setup, measured, expected));
  require(comparison.disagreements == 0, "pixels that are not the same",
          static_cast<double>(comparison.disagreements), setup);
  require(comparison.distance_max_m <= setup.max_error_m, "error in m", comparison.distance_max_m, setup);
  require(measured.accuracy.claimed_m.value_or(0.0) <= setup.max_error_m, "claimed error in m",
          measured.accuracy.claimed_m.value_or(0.0), setup);
  require(measured.accuracy.found_m.value_or(0.0) <= setup.max_error_m, "found error in m",
          measured.accuracy.found_m.value_or(0.0), setup);
}

void check(Simulator &simulator, const RandomSetup &setup) {
  Measurement measured;
  if (fuzz::accepts(
          [&] {
            simulator.prepare(setup.scene, setup.sensor, setup.illuminators, setup.backscatter, setup.shadows,
                              within_budget(setup));
            measured = simulator.measure();
          },
          {ExitCode::accuracy, ExitCode::input}))
    compare_with_reference(setup, measured);
}

} // namespace

FUZZ_TARGET(setups) {
  static Simulator simulator = test::make_simulator(
      {.device = {}, .keep_sample_ids = true, .keep_visibility = true, .loop = DiodeLoop::looped});
  fuzz::Decoder bytes(data, size);
  const RandomSetup setup = any_setup(bytes);
  if (lens_fault(setup.sensor))
    return 0; // setups with such lenses are refused when they are read
  check(simulator, setup);
  test::Random random(static_cast<std::uint32_t>(std::hash<std::string_view>()(fuzz::text_of(data, size))));
  for (unsigned turn = 0; turn < turns; ++turn) {
    RandomSetup varied = setup;
    vary(varied, random);
    check(simulator, varied);
  }
  return 0;
}
