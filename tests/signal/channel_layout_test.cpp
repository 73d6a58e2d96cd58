// Where the device keeps channels, and what it is told of each frequency.

#include "engine/signal/channel_layout.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

using namespace pmdsim;

namespace {

const std::vector<double> modulation_hz{20e6, 1e3, 10e9};

Modulation signal_with_taps() {
  Sensor sensor;
  sensor.modulation_hz = modulation_hz;
  return modulation_of(sensor, {.device = {}, .keep_taps = true});
}

double sum_of(const shader::vec2 &pair) { return double{pair.x} + double{pair.y}; }

void check_largest_below(float below, double limit) {
  CHECK(double{below} < limit);
  CHECK(double{std::nextafter(below, std::numeric_limits<float>::infinity())} >= limit);
}

ChannelLayout layout_of(const SimulatorOptions &options, bool lit) {
  Sensor sensor;
  sensor.taps = 7;
  sensor.modulation_hz = {20e6, 30e6};
  Modulation signal = modulation_of(sensor, options);
  signal.lit = lit;
  return ChannelLayout(signal);
}

} // namespace

TEST_CASE(
    "channels are the ground truth, then each frequency's in pairs, with its taps where they are kept") {
  const ChannelLayout without = layout_of({}, false);
  CHECK(without.first_channel(0) == 4);
  CHECK(without.first_channel(1) == 8);
  CHECK(without.channels() == 12);
  const ChannelLayout with = layout_of({.device = {}, .keep_taps = true}, true);
  CHECK(with.first_channel(0) == 4);
  CHECK(with.first_channel(1) == 16);
  CHECK(with.lit_channel() == 28);
  CHECK(with.channels() == 30);
}

TEST_CASE("channels that a layout holds have a number each, and the range is the first frequency's") {
  const ChannelLayout without = layout_of({}, false);
  CHECK_FALSE(without.holds(row_of(&Measurement::lit)));
  CHECK_FALSE(without.holds(row_of(&Return::taps)));
  const ChannelLayout with = layout_of({.device = {}, .keep_taps = true}, true);
  Measurement frame;
  frame.returns.resize(2);
  for (Return &of_frequency : frame.returns)
    of_frequency.taps.resize(7);
  std::set<std::uint32_t> numbers;
  std::size_t channels = 0;
  for_each_channel(frame, [&](const ChannelIndex &of, auto &) {
    using Area = DeviceSlot::Area;
    if (of.row.slot.area != Area::truth && of.row.slot.area != Area::frequency &&
        of.row.slot.area != Area::shadow) {
      CHECK_FALSE(with.holds(of.row));
      return;
    }
    CHECK(with.holds(of.row));
    CHECK(with.number(of) < with.channels());
    numbers.insert(with.number(of));
    ++channels;
  });
  CHECK(channels == 6 + 2 * (3 + 7));
  CHECK(numbers.size() == channels);
  CHECK(with.number({row_of(&Measurement::range_m)}) == 7);
  CHECK(with.number({row_of(&Return::distance_m), 1}) == 18);
  CHECK(with.number({row_of(&Return::taps), 1, 6}) == 26);
}

TEST_CASE("the mean light is a channel of its own behind all others, and a frequency without a phase") {
  Modulation signal = signal_with_taps();
  const ChannelLayout without(signal);
  const std::uint32_t sums = signal.sum_planes();
  signal.keeps_mean = true;
  const ChannelLayout with(signal);
  CHECK(with.frequencies == without.frequencies);
  CHECK(with.holds(row_of(&Measurement::mean_radiance)));
  CHECK_FALSE(without.holds(row_of(&Measurement::mean_radiance)));
  CHECK(with.number({row_of(&Measurement::mean_radiance)}) == without.channels());
  CHECK(with.channels() == without.channels() + 2);
  CHECK(signal.sum_planes() == sums + signal.planes);
  const auto records = frequency_records(signal, 2.5, {}, 240);
  REQUIRE(records.size() == modulation_hz.size() + 1);
  CHECK(records.back().first_channel == with.mean_channel());
  CHECK(records.back().ambiguity_m.x == 0.0f);
  CHECK(signal.all_tones().back().turns_per_m.x == 0.0f);
  CHECK(signal.all_tones().back().harmonic == 0.0f);
}

TEST_CASE("bounds lie behind each frequency's taps, where they are kept") {
  Modulation signal = signal_with_taps();
  const ChannelLayout without(signal);
  signal.keeps_bounds = true;
  const ChannelLayout with(signal);
  CHECK(with.holds(row_of(&Return::error_bound_m)));
  CHECK(with.channels() == without.channels() + 6);
  CHECK(with.number({row_of(&Return::error_bound_m), 0}) + 2 == with.first_channel(1));
  CHECK(with.number({row_of(&Return::error_bound_m), 2}) + 2 == with.lit_channel());
}

TEST_CASE("what rounding takes lies behind each frequency's bounds, where it is kept") {
  Modulation signal = signal_with_taps();
  signal.keeps_bounds = true;
  const ChannelLayout without(signal);
  signal.keeps_rests = true;
  const ChannelLayout with(signal);
  CHECK(with.channels() == without.channels() + 6);
  for (std::uint32_t f = 0; f < 3; ++f) {
    CHECK(with.rest_channels(f) == with.number({row_of(&Return::error_bound_m), f}) + 2);
    CHECK(with.rest_channels(f) + 2 == with.first_channel(f + 1));
  }
}

TEST_CASE("a frequency's turns and its ambiguity, to double precision") {
  const auto records = frequency_records(signal_with_taps(), 2.5, {}, 240);
  REQUIRE(records.size() == modulation_hz.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    INFO(modulation_hz[i] << " Hz");
    const double ambiguity_m = 299792458.0 / (2.0 * modulation_hz[i]);
    CHECK(sum_of(records[i].ambiguity_m) == Approx(ambiguity_m).epsilon(1e-14));
    CHECK(sum_of(records[i].turns_per_m) == Approx(1.0 / ambiguity_m).epsilon(1e-14));
    check_largest_below(records[i].below.x, 2.0 * std::numbers::pi);
    check_largest_below(records[i].below.y, ambiguity_m);
  }
}

TEST_CASE("a frequency knows its channels and its unit") {
  const Modulation signal = signal_with_taps();
  const auto records = frequency_records(signal, 2.5, {}, 240);
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    CHECK(records[i].first_channel == ChannelLayout(signal).first_channel(i));
    CHECK(records[i].amplitude_scale == 2.5f);
  }
}

TEST_CASE("every frequency carries what was promised, or nothing") {
  for (const shader::Frequency &record : frequency_records(signal_with_taps(), 1.0, {}, 240))
    CHECK((record.limit_m == 0.0f && record.per_condition_m == 0.0f && record.amplitude_limit == 0.0f));
  ErrorBound bound{1e-5, 2e-6, 3e-7, 1e-3, 2e-4, 3e-5};
  bound.per_weight_m = 0x1p24;
  bound.any_weight_m = 0x1p25;
  bound.weight_error = 0x1p-20;
  bound.even_part = 0.375;
  const auto alike = frequency_records(signal_with_taps(), 1.0, bound, 240);
  CHECK((alike[0].near_per_condition_m == 3e-7f && alike[0].near_per_weight_m == 1.0f &&
         alike[0].per_apart == 0.0f));
  CHECK((alike[0].weight_error == 16.0f && alike[0].any_weight_m == 2.0f && alike[0].even_part == 0.375f));
  bound.at_one_range = {1e-6, 1e-7, 0x1p23, 4e-8};
  for (const shader::Frequency &record : frequency_records(signal_with_taps(), 1.0, bound, 240)) {
    CHECK(record.limit_m == 1e-5f);
    CHECK(record.fixed_m == 2e-6f);
    CHECK(record.per_condition_m == 3e-7f);
    CHECK(record.amplitude_limit == 1e-3f);
    CHECK(record.amplitude_fixed == 2e-4f);
    CHECK(record.amplitude_per_condition == 3e-5f);
    CHECK((record.near_fixed_m == 1e-6f && record.near_per_condition_m == 1e-7f));
    CHECK((record.per_apart == 4e-8f && record.near_per_weight_m == 0.5f && record.per_weight_m == 1.0f));
  }
}
