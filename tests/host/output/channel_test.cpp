#include "host/output/files/channel.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

// One pixel; every channel of a frequency holds a value of its own.
Measurement measurement_of(std::size_t frequencies, std::size_t taps) {
  Measurement measurement;
  measurement.resolution = {1, 1};
  for (std::size_t i = 0; i < frequencies; ++i) {
    const auto value = static_cast<float>(100 * i);
    Return of_frequency{{value + 1}, {value + 2}, {value + 3}, {}};
    for (std::size_t k = 0; k < taps; ++k)
      of_frequency.taps.push_back({value + 10 + static_cast<float>(k)});
    measurement.returns.push_back(of_frequency);
  }
  measurement.range_m = measurement.z_m = measurement.coverage = {0.5f};
  measurement.triangle_id = measurement.object_id = {7};
  return measurement;
}

std::vector<std::string> names_of(const ChannelSet &set) {
  std::vector<std::string> names;
  for (const Channel &channel : set.channels)
    names.push_back(channel.name());
  return names;
}

float value_of(const ChannelSet &set, const std::string &name) {
  for (const Channel &channel : set.channels)
    if (channel.name() == name)
      return std::get<std::span<const float>>(channel.values)[0];
  throw std::logic_error("there is no channel " + name);
}

const std::vector<std::string> ground_truth{"range_m", "z_m", "coverage", "triangle_id", "object_id"};

std::vector<std::string> before_ground_truth(std::vector<std::string> names) {
  names.insert(names.end(), ground_truth.begin(), ground_truth.end());
  return names;
}

} // namespace

TEST_CASE("lit is a channel of ground truth where shadows fill it") {
  Measurement measurement = measurement_of(1, 0);
  measurement.lit = {0.25f};
  const ChannelSet set = channels_of(measurement);
  CHECK(names_of(set) == std::vector<std::string>{"amplitude", "phase_rad", "distance_m", "range_m", "z_m",
                                                  "coverage", "lit", "triangle_id", "object_id"});
  CHECK(value_of(set, "lit") == 0.25f);
  CHECK(set.channels[6].unit.empty());
}

TEST_CASE("the channels of one frequency carry no prefix") {
  CHECK(names_of(channels_of(measurement_of(1, 0))) ==
        before_ground_truth({"amplitude", "phase_rad", "distance_m"}));
  CHECK(names_of(channels_of(measurement_of(1, 3))) ==
        before_ground_truth({"amplitude", "phase_rad", "distance_m", "tap0", "tap1", "tap2"}));
}

TEST_CASE("of several frequencies each channel carries its own, and the taps come last") {
  const Measurement measurement = measurement_of(2, 3);
  const ChannelSet set = channels_of(measurement);
  CHECK(names_of(set) == before_ground_truth({"f0.amplitude", "f0.phase_rad", "f0.distance_m", "f1.amplitude",
                                              "f1.phase_rad", "f1.distance_m", "f0.tap0", "f0.tap1",
                                              "f0.tap2", "f1.tap0", "f1.tap1", "f1.tap2"}));
  CHECK(value_of(set, "f0.phase_rad") == 2.0f);
  CHECK(value_of(set, "f1.distance_m") == 103.0f);
  CHECK(value_of(set, "f1.tap2") == 112.0f);
  CHECK(set.channels[6].unit == "W/(m² sr)");
}
