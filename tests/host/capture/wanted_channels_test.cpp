// Which channels are wanted, what has to be made for them, and that their bits are those of a whole frame.

#include "engine/model/error.h"
#include "host/capture/exposure.h"
#include "host/capture/wanted_channels.h"
#include "host/output/files/channel.h"
#include "tests/program/program.h"

#include <bit>
#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace pmdsim;

namespace {

const Bounces without_bounces;
const Accuracy automatic = [] {
  Accuracy accuracy;
  accuracy.mode = Mode::automatic;
  return accuracy;
}();

Sensor noisy_sensor() {
  Sensor sensor;
  sensor.modulation_hz = {20e6, 30e6};
  sensor.electronics.emplace().noiseless_channels = true;
  return sensor;
}

FramePart part_of_names(const std::vector<std::string> &names, const Sensor &sensor,
                        const Bounces &bounces = without_bounces, const Accuracy &accuracy = {}) {
  return part_of(WantedChannels(names), sensor, bounces, accuracy);
}

// Any values, by the names of files.
std::map<std::string, std::vector<std::uint32_t>> bits_of_frame(const Measurement &frame) {
  std::map<std::string, std::vector<std::uint32_t>> bits;
  for (const Channel &channel : channels_of(frame).channels)
    std::visit(
        [&](auto values) {
          for (const auto value : values)
            bits[channel.name()].push_back(std::bit_cast<std::uint32_t>(value));
        },
        channel.values);
  return bits;
}

// A frame of the setup in the second of two frames, so that memory is used again.
std::map<std::string, std::vector<std::uint32_t>> taken_bits(const Setup &setup, const WantedChannels &wanted,
                                                             const Accuracy &accuracy = {}) {
  Exposures exposures(setup, "", true, accuracy, 0, wanted);
  const Progress none = [](double) {};
  for (std::size_t sensor = 0; sensor < setup.start.sensors.size(); ++sensor)
    exposures.share(exposures.take(sensor, 0, Light::beside_lens, none));
  return bits_of_frame(exposures.take(0, 0, Light::beside_lens, none).measurement);
}

// Each wanted channel is there, no other, and all have the bits of the whole frame.
void check_same_bits(const Setup &setup, const std::vector<std::vector<std::string>> &sets,
                     const Accuracy &accuracy = {}) {
  const auto whole = taken_bits(setup, {}, accuracy);
  for (const std::vector<std::string> &names : sets) {
    const WantedChannels wanted(names);
    const auto some = taken_bits(setup, wanted, accuracy);
    CHECK(some.size() >= names.size());
    for (const auto &[name, bits] : some) {
      INFO(setup.file << ", " << names.front() << " ...: " << name);
      CHECK(whole.contains(name));
      const bool same = whole.contains(name) && whole.at(name) == bits; // Catch would print all of them
      CHECK(same);
    }
  }
}

Setup shipped(const std::string &name, const glm::uvec2 &resolution) {
  Setup setup = load_setup(test::scene(name));
  for (Sensor &sensor : setup.start.sensors) {
    const glm::dvec2 larger = glm::dvec2(sensor.resolution) / glm::dvec2(resolution);
    sensor.pixel_pitch_m *= larger;
    sensor.resolution = resolution;
  }
  return setup;
}

const std::vector<std::vector<std::string>> noiseless_sets{
    {"range_m", "z_m", "coverage", "triangle_id", "object_id"},
    {"lit", "z_m"},
    {"distance_m"},
    {"tap"},
    {"amplitude", "range_m"}};

} // namespace

TEST_CASE("channels are wanted by name, of a frequency or of all, and of all taps") {
  const WantedChannels all, some({"f1.distance_m", "tap", "z_m"});
  CHECK(all.are_all());
  CHECK(all.has(row_of(&Measurement::lit)));
  CHECK(all.has_own("deformation_mm"));
  CHECK(all.have_taps());
  CHECK(!some.are_all());
  CHECK(some.have_taps());
  CHECK(some.has({row_of(&Return::distance_m), 1}));
  CHECK(!some.has({row_of(&Return::distance_m), 0}));
  CHECK(some.has({row_of(&Return::taps), 1, 3}));
  CHECK(some.has({row_of(&Measurement::z_m)}));
  CHECK(!some.has(row_of(&Return::amplitude)));
  CHECK(!some.has_own("deformation_mm"));
  CHECK(WantedChannels({"deformation_mm"}, {"deformation_mm"}).has_own("deformation_mm"));
  CHECK(some.with(row_of(&Return::amplitude)).has(row_of(&Return::amplitude)));
  CHECK(all.with(row_of(&Return::amplitude)).are_all());
}

TEST_CASE("names that are none are refused with the one that is near or those that there are") {
  for (const std::string name : {"", "f1.z_m", "deformation_mm", "f1.f1.tap"}) {
    INFO(name);
    CHECK_THROWS_WITH(WantedChannels({name}),
                      Catch::Contains("--channels: unknown channel \"" + name + "\"") &&
                          Catch::Contains("amplitude, phase_rad, distance_m"));
  }
  for (const auto &[name, meant] :
       std::vector<std::pair<std::string, std::string>>{{"distance", "distance_m"},
                                                        {"tap0", "tap"},
                                                        {"f.distance_m", "distance_m"},
                                                        {"f01.distance_m", "distance_m"}})
    CHECK_THROWS_WITH(WantedChannels({name}),
                      "--channels: unknown channel \"" + name + "\", did you mean \"" + meant + "\"?");
  CHECK_THROWS_WITH(WantedChannels({"x"}, {"deformation_mm"}), Catch::Contains("expected of deformation_mm"));
}

TEST_CASE("only what a channel is made of is made") {
  const Sensor noisy = noisy_sensor(), noiseless;
  Bounces bounces;
  bounces.count = 1;
  CHECK(part_of_names({"z_m", "range_m", "coverage", "triangle_id", "object_id"}, noisy) == FramePart::truth);
  CHECK(part_of_names({"multipath_m"}, noisy) == FramePart::truth); // not there
  CHECK(part_of_names({"lit", "z_m"}, noisy) == FramePart::visibility);
  CHECK(part_of_names({"direct_distance_m"}, noisy, bounces) == FramePart::direct_light);
  CHECK(part_of_names({"multipath_m"}, noisy, bounces) == FramePart::light);
  CHECK(part_of_names({"mean_radiance"}, noisy) == FramePart::light);
  CHECK(part_of_names({"distance_m_noiseless"}, noisy) == FramePart::light);
  CHECK(part_of_names({"distance_m"}, noisy) == FramePart::electrons);
  CHECK(part_of_names({"distance_m"}, noiseless) == FramePart::light);
  CHECK(part_of_names({"saturated"}, noisy) == FramePart::electrons);
  CHECK(part_of(WantedChannels(), noisy, bounces, {}) == FramePart::electrons);
  CHECK(part_of_names({"z_m"}, noisy, without_bounces, automatic) == FramePart::light);
}

TEST_CASE("a sensor loses what its wanted channels do not need") {
  Sensor noisy = noisy_sensor();
  noisy.unwrap_range_m = 10.0;
  noisy.scatter = {{0.1, 1e-4}};
  const WantedChannels distance({"distance_m"}), noiseless({"distance_m_noiseless"});
  CHECK(leaves_noiseless(distance, {noisy}));
  CHECK(!leaves_noiseless(noiseless, {noisy}));
  Sensor without = noisy;
  without.electronics->noiseless_channels = false;
  CHECK(!leaves_noiseless(distance, {noisy, without}));
  CHECK(!reduced_to(distance, FramePart::electrons, true, noisy).electronics->noiseless_channels);
  CHECK(reduced_to(distance, FramePart::electrons, false, noisy).electronics->noiseless_channels);
  CHECK(reduced_to(distance, FramePart::electrons, true, noisy).unwrap_range_m == 0.0);
  CHECK(reduced_to(WantedChannels({"unwrap_ok"}), FramePart::electrons, true, noisy).unwrap_range_m == 10.0);
  CHECK(reduced_to(noiseless, FramePart::light, false, without).electronics->noiseless_channels);
  CHECK(reduced_to(noiseless, FramePart::light, false, noisy).scatter.size() == 1);
  const Sensor truth = reduced_to(WantedChannels({"z_m"}), FramePart::truth, true, noisy);
  CHECK(!truth.electronics);
  CHECK(truth.scatter.empty());
  CHECK(truth.modulation_hz.size() == 1);
}

TEST_CASE("channels that the setup has not are refused with those that it has") {
  const Setup setup = load_setup(test::scene("electronics/kinect_v2_like.json"));
  const auto require = [&](const std::vector<std::string> &names, const Accuracy &accuracy = {}) {
    WantedChannels(names).require_in(setup, accuracy);
  };
  CHECK_NOTHROW(require({"f2.distance_m", "lit", "amplitude_noiseless"}));
  CHECK_NOTHROW(require({"error_bound_m", "z_m"}, automatic));
  CHECK_THROWS_WITH(require({"f3.distance_m"}),
                    Catch::Contains("has \"f3.distance_m\", expected of amplitude"));
  CHECK_THROWS_WITH(require({"lit", "multipath_m"}),
                    Catch::Contains("has \"multipath_m\"") && !Catch::Contains(", direct_amplitude"));
  CHECK_THROWS_WITH(require({"error_bound_m", "z_m"}), Catch::Contains("has \"error_bound_m\""));
  CHECK_THROWS_WITH(require({"error_bound_m"}, automatic), Catch::Contains("would be empty"));
}

TEST_CASE("fewer channels take less memory") {
  Sensor sensor = noisy_sensor();
  sensor.resolution = {10, 10};
  CHECK(bytes_of_frame(sensor, true, without_bounces, WantedChannels({"z_m"})) == 400);
  CHECK(bytes_of_frame(sensor, true, without_bounces, WantedChannels({"distance_m", "tap"})) == 400 * 2 * 5);
  CHECK(bytes_of_frame(sensor, false, without_bounces, WantedChannels({"distance_m", "tap"})) == 400 * 2);
}

TEST_CASE("wanted channels have the bits of a whole frame: shadows, an error") {
  check_same_bits(shipped("room.json", {64, 48}), noiseless_sets);
  check_same_bits(shipped("penumbra.json", {48, 48}), noiseless_sets, automatic);
}

TEST_CASE("wanted channels have the bits of a whole frame: diagrams, samples, several frequencies",
          "[long]") {
  check_same_bits(shipped("light.json", {48, 48}), noiseless_sets);
  Setup several = shipped("room.json", {40, 30});
  several.start.sensors[0].modulation_hz = {20e6, 30e6};
  set_samples(several.start.sensors[0], {.samples = 2});
  check_same_bits(several, noiseless_sets);
  set_samples(several.start.sensors[0], automatic_samples);
  check_same_bits(several, noiseless_sets);
}

TEST_CASE("wanted channels have the bits of a whole frame: electrons") {
  Setup setup = shipped("electronics/kinect_v2_like.json", {64, 53});
  const std::vector<std::vector<std::string>> sets{{"range_m", "object_id"},
                                                   {"lit"},
                                                   {"distance_m"},
                                                   {"f1.amplitude", "confidence"},
                                                   {"mean_radiance", "z_m"},
                                                   {"unwrapped_distance_m", "unwrap_ok"},
                                                   {"saturated", "distance_noise_m"},
                                                   {"tap", "tap_a_e", "tap_b_dn"}};
  const std::vector<std::string> noiseless{"amplitude_noiseless", "distance_m_noiseless"};
  auto with_noiseless = sets;
  with_noiseless.push_back(noiseless);
  check_same_bits(setup, with_noiseless);
  setup.start.sensors[0].scatter = {{0.1, 1e-4}};
  check_same_bits(setup, with_noiseless);
  setup.start.sensors[0].scatter.clear();
  setup.start.sensors[0].electronics->noiseless_channels = false;
  check_same_bits(setup, sets);
  setup.start.sensors[0].waveform.kind = Waveform::Kind::square;
  check_same_bits(setup, sets);
}

TEST_CASE("wanted channels have the bits of a whole frame: light that bounces, and taps in sequence",
          "[long]") {
  Setup corner = shipped("corner.json", {24, 24});
  const std::vector<std::vector<std::string>> sets{{"z_m"},
                                                   {"direct_distance_m", "direct_phase_rad"},
                                                   {"multipath_m", "indirect_share"},
                                                   {"distance_m"},
                                                   {"direct_amplitude", "multipath_error_m"}};
  check_same_bits(corner, sets);
  set_samples(corner.start.sensors[0], {.samples = 2});
  check_same_bits(corner, sets);
  check_same_bits(shipped("motion.json", {40, 30}), noiseless_sets);
}
