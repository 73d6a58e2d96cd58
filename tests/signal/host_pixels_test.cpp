// Pixels that the host takes from depth records to channels at once, in vectors of every width, beside those
// that the device makes and against the reference.

#include "tests/comparison/comparison.h"
#include "tests/comparison/light_formula.h"
#include "tests/support/scenes.h"
#include "tests/support/simulator.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <initializer_list>
#include <optional>
#include <vector>

using namespace pmdsim;
using namespace pmdsim::test;

namespace {

// Two slants, a board before them, a side wall that turns away from half of the light, and nothing beside
// them.
Scene scene_of() {
  SceneBuilder builder;
  builder.add_mesh({{-3, -3, 2.5}, {1.1, -3, 1.5}, {1.1, 3, 1.9}, {-3, 3, 2.9}}, {{0, 2, 1}, {0, 3, 2}});
  builder.add_mesh({{-3, 0.5, 1.2}, {3, 0.5, 1.2}, {3, 0.9, 3.5}, {-3, 0.9, 3.5}}, {{0, 2, 1}, {0, 3, 2}},
                   {.reflectivity = 0.4});
  builder.add_mesh({{-0.2, -0.6, 1.0}, {-0.2, 0.3, 1.0}, {-0.3, 0.3, 1.9}, {-0.3, -0.6, 1.9}},
                   {{0, 1, 2}, {0, 2, 3}}, {.reflectivity = 0.8, .double_sided = true});
  builder.add_wall({1.0, {.reflectivity = 0.7}, {0.05, -0.1}, {0.2, 0.15}});
  return builder.scene();
}

struct PixelCase {
  std::string name;
  Backscatter backscatter = Backscatter::lambert;
  Shadows shadows = Shadows::automatic;
  Pattern pattern = cosine(3.0);
  std::function<void(Sensor &)> change = [](Sensor &) {};
  double phase_rad = 0.0;
  double along_m = 0.0; // of every other diode, off the others' plane
  glm::dvec3 axis{0.0, 0.0, 1.0};
  int diodes = 100;
  // With a second board beside the first, of another phase and turned: runs of their own.
  bool second_board = false;

  bool is_one_run() const { return diodes == 100 && !second_board; }
};

PixelCase with_runs(const std::string &name, Shadows shadows, int diodes, bool second_board) {
  PixelCase of{name, Backscatter::lambert, shadows};
  of.diodes = diodes;
  of.second_board = second_board;
  return of;
}

std::vector<PixelCase> pixel_cases() {
  return {
      {"shadows"},
      {"light through all", Backscatter::lambert, Shadows::off},
      {"the paper's backscatter", Backscatter::constant, Shadows::automatic, {}},
      {"frequencies", Backscatter::lambert, Shadows::automatic, cosine(1.0),
       [](Sensor &sensor) {
         sensor.modulation_hz = {20e6, 31e6, 7e6};
       }},
      {"a phase, taps", Backscatter::lambert, Shadows::automatic, cosine(3.0),
       [](Sensor &sensor) { sensor.taps = 5; }, 1.3},
      {"vignetting", Backscatter::lambert, Shadows::automatic, cosine(3.0),
       [](Sensor &sensor) { sensor.vignetting = Vignetting::cos4; }},
      {"a tilted chip", Backscatter::lambert, Shadows::automatic, cosine(3.0),
       [](Sensor &sensor) {
         sensor.chip.rotation_rad = {0.05, -0.03, 0.2};
       }},
      {"two planes", Backscatter::lambert, Shadows::automatic, cosine(1.0), [](Sensor &) {}, 0.0, 0.01},
      with_runs("two boards", Shadows::automatic, 100, true),
      with_runs("two boards, light through all", Shadows::off, 100, true),
      with_runs("600 diodes", Shadows::automatic, 600, false),
  };
}

// Beside their ends floats know little of their light.
PixelCase beams_that_end_in_view() {
  PixelCase beams{"beams that end in view"};
  beams.pattern = cosine(8.0);
  beams.axis = {1.0, 0.1, 0.05};
  return beams;
}

// Too narrow for tables; between them is little light.
PixelCase narrow_beams() {
  PixelCase beams{"narrow beams"};
  beams.pattern = cosine(60.0);
  beams.axis = {0.3, 0.1, 1.0};
  return beams;
}

std::vector<Illuminator> lights_of(const PixelCase &of) {
  std::vector<Illuminator> lights{light_at(ring(of.diodes, 0.12), of.phase_rad, of.pattern)};
  for (std::size_t i = 0; i < lights[0].diodes.size(); i += 2)
    lights[0].diodes[i].position_m.z += of.along_m;
  for (Diode &diode : lights[0].diodes)
    diode.axis = glm::normalize(of.axis);
  if (of.second_board) {
    lights.push_back(light_at(ring(60, 0.03), of.phase_rad + 0.7, cosine(1.0)));
    for (Diode &diode : lights[1].diodes) {
      diode.position_m = {0.25 + 0.9 * diode.position_m.x, diode.position_m.y, 0.3 * diode.position_m.x};
      diode.axis = glm::normalize(glm::dvec3(-0.2, 0.0, 1.0));
    }
  }
  return lights;
}

// Rows end within vectors and within blocks.
Sensor sensor_of(const PixelCase &of) {
  Sensor sensor = wide_sensor();
  sensor.resolution = {43, 30};
  of.change(sensor);
  return sensor;
}

// Otherwise, as with a GPU, the host is asked for pixels in vain, and the device's are compared with
// themselves.
bool host_is_device() {
  const std::vector<DeviceInfo> devices = list_devices();
  const auto used = std::ranges::find_if(devices, &DeviceInfo::usable);
  return used != devices.end() && used->kind == "CPU";
}

// `bits` of the host's vectors; 0: on the device. All pixels go to channels at once, where `direct`.
Measurement measured(const PixelCase &of, std::uint32_t bits, const Accuracy &accuracy = {},
                     bool direct = true) {
  SimulatorOptions options;
  options.keep_sample_ids = options.keep_taps = options.keep_error_bound = true;
  options.loop = DiodeLoop::looped; // compiles faster
  options.host_vector_bits = bits;
  options.max_strip_samples = bits == 256 ? 900 : 0;
  options.allowed.host_pixels = bits > 0;
  Simulator simulator = make_simulator(options);
  const Scene scene = scene_of(); // which outlasts the frame
  simulator.prepare(scene, sensor_of(of), lights_of(of), of.backscatter, of.shadows, accuracy);
  const auto path = simulator.path();
  const auto record = std::ranges::find(path, "record", &std::pair<std::string, std::string>::first);
  REQUIRE(record != path.end());
  INFO(record->second);
  CHECK((record->second.find("at once on the host") != std::string::npos) == (bits > 0 && host_is_device()));
  CHECK((record->second.find("at once") != std::string::npos) == direct);
  return simulator.measure();
}

float largest(const std::vector<float> &values) {
  return values.empty() ? 0.0f : *std::ranges::max_element(values);
}

// Values that are both not there, or nearly the same.
void check_near(const std::vector<float> &a, const std::vector<float> &b, float tolerance) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    INFO(i << ": " << a[i] << " and " << b[i]);
    REQUIRE(std::isnan(a[i]) == std::isnan(b[i]));
    REQUIRE((std::isnan(a[i]) || a[i] == b[i] || std::abs(a[i] - b[i]) <= tolerance));
  }
}

void check_the_same(const Measurement &host, const Measurement &device) {
  check_near(host.range_m, device.range_m, 0.0f);
  check_near(host.z_m, device.z_m, 0.0f);
  check_near(host.coverage, device.coverage, 0.0f);
  check_near(host.lit, device.lit, 0.0f);
  CHECK(host.triangle_id == device.triangle_id);
  for (std::size_t f = 0; f < host.returns.size(); ++f) {
    const Return &of_host = host.returns[f], &of_device = device.returns[f];
    const float brightest = largest(of_device.amplitude);
    check_near(of_host.amplitude, of_device.amplitude, 2e-6f * brightest);
    check_near(of_host.distance_m, of_device.distance_m, 0.6e-6f);
    check_near(of_host.phase_rad, of_device.phase_rad, 1e-6f);
    REQUIRE(of_host.taps.size() == of_device.taps.size());
    for (std::size_t k = 0; k < of_host.taps.size(); ++k)
      check_near(of_host.taps[k], of_device.taps[k], 2e-6f * brightest);
  }
}

void check_pixels_of_host(const std::vector<PixelCase> &cases) {
  fmt::print("{}", comparison_heading());
  for (const PixelCase &of : cases) {
    INFO(of.name);
    const Sensor sensor = sensor_of(of);
    const auto expected =
        reference::simulate(scene_of(), sensor, lights_of(of), of.backscatter, {.shadows = of.shadows});
    const Measurement device = measured(of, 0, {}, of.is_one_run());
    for (const std::uint32_t bits : {512u, 256u, 128u}) {
      INFO(bits << " bits");
      const Measurement host = measured(of, bits);
      check_the_same(host, device);
      const Comparison comparison = compare(host, expected, scene_of(), sensor);
      fmt::print("{}", comparison_row(fmt::format("{}, {} bits", of.name, bits), comparison));
      CHECK(comparison.pixels >= 900);
      CHECK(comparison.distance_max_m <= 0.6e-6);
      CHECK(comparison.amplitude_max_relative <= 5e-6);
    }
  }
}

// `tolerance`: relative. Where tables stand for roots, the host's bounds may be `growth` times the device's.
void check_bounds(const Measurement &host, const Measurement &device, double tolerance, double growth) {
  if (growth == 1.0) {
    CHECK(host.accuracy.unpromised == device.accuracy.unpromised);
    CHECK(host.accuracy.claimed_m.value() == Approx(device.accuracy.claimed_m.value()).epsilon(tolerance));
    CHECK(host.accuracy.claimed_amplitude.value() ==
          Approx(device.accuracy.claimed_amplitude.value()).epsilon(tolerance));
  }
  double most = 1.0;
  for (std::size_t f = 0; f < host.returns.size(); ++f) {
    const auto &of_host = host.returns[f].error_bound_m, &of_device = device.returns[f].error_bound_m;
    REQUIRE(of_host.size() == of_device.size());
    for (std::size_t i = 0; i < of_host.size(); ++i) {
      INFO(i << ": " << of_host[i] << " and " << of_device[i]);
      REQUIRE(std::isnan(of_host[i]) == std::isnan(of_device[i]));
      const double ratio = static_cast<double>(of_host[i]) / static_cast<double>(of_device[i]);
      REQUIRE((std::isnan(of_host[i]) || of_host[i] == of_device[i] ||
               (ratio >= 1.0 - tolerance && ratio <= growth * (1.0 + tolerance))));
      most = std::isnan(ratio) ? most : std::max(most, ratio);
    }
  }
  CHECK((growth == 1.0 || most > 1.5));
}

// `exact`: in double.
void check_within_bounds(const Measurement &host, const Measurement &exact) {
  for (std::size_t f = 0; f < host.returns.size(); ++f)
    for (std::size_t i = 0; i < host.range_m.size(); ++i) {
      const double should_m = static_cast<double>(exact.returns[f].distance_m[i]);
      const double off_m = std::abs(static_cast<double>(host.returns[f].distance_m[i]) - should_m);
      REQUIRE((std::isnan(should_m) ||
               off_m <= static_cast<double>(host.returns[f].error_bound_m[i]) + 0x1p-24 * should_m));
    }
}

void check_bounds_of_host(std::initializer_list<std::uint32_t> vector_bits,
                          const std::vector<PixelCase> &cases) {
  Accuracy within, precise;
  within.mode = Mode::automatic;
  within.max_error_m = 100e-6;
  within.precision = Precision::fp32; // so that no pixel is summed again in double
  precise.precision = Precision::fp64;
  for (const PixelCase &of : cases) {
    // On the device pixels that turn away from some source, and boards in space, are sorted into classes.
    const bool sorts = of.shadows == Shadows::off || !of.is_one_run();
    if (of.along_m != 0.0)
      continue;
    // So little that no set of few diodes does for the runs, whose pixels would be sorted then.
    within.max_error_m = of.is_one_run() ? 100e-6 : 15e-6;
    const Measurement exact = measured(of, 0, precise, false);
    const std::optional<Measurement> device = sorts ? std::nullopt : std::optional(measured(of, 0, within));
    for (const std::uint32_t bits : vector_bits) {
      INFO(of.name << ", " << bits << " bits");
      const Measurement host = measured(of, bits, within);
      check_within_bounds(host, exact);
      if (device && of.pattern.order == 8.0)
        check_bounds(host, *device, 2e-2, 8.0); // as far as light is known
      else if (device) // within beams few sources shine: hardly any light cancels, and rounding shows in that
        check_bounds(host, *device, of.pattern.order > 8.0 ? 2e-2 : 1e-3, 1.0);
    }
  }
}

std::vector<PixelCase> bounded_cases() {
  std::vector<PixelCase> cases = pixel_cases();
  cases.push_back(beams_that_end_in_view());
  cases.push_back(narrow_beams());
  return cases;
}

} // namespace

TEST_CASE("the host makes pixels as the device does, and as the reference") {
  check_pixels_of_host(every_third(pixel_cases()));
}

TEST_CASE("the host makes all kinds of pixels as the device does, and as the reference", "[long]") {
  check_pixels_of_host(pixel_cases());
}

TEST_CASE("the host bounds a pixel's error as the device does") {
  check_bounds_of_host({512}, every_third(bounded_cases()));
}

TEST_CASE("vectors of any width bound a pixel's error as the device does", "[long]") {
  check_bounds_of_host({512, 256, 128}, bounded_cases());
}
