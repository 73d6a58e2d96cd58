// What is said of how exact frames are.

#include "host/commands/report.h"
#include "host/commands/timing.h"
#include "host/output/accuracy_record.h"

#include <catch2/catch.hpp>

using namespace pmdsim;

namespace {

AccuracyReport full_report() {
  AccuracyReport report;
  report.precision = Precision::fp64;
  report.diodes = 15;
  report.claimed_m = 4e-6;
  report.claimed_amplitude = 2e-5;
  report.found_m = 1.25e-6;
  report.checked_pixels = 1024;
  report.check_ms = 2.0;
  return report;
}

} // namespace

TEST_CASE("a frame in mode exact without a check has nothing to say") {
  CHECK(accuracy_text(Mode::exact, {}).empty());
  const auto json = accuracy_json(AccuracyReport{});
  CHECK(json["precision"] == "fp32");
  for (const char *key :
       {"error_claimed_m", "error_found_m", "amplitude_error_claimed", "amplitude_error_found"})
    CHECK(json[key].is_null());
}

TEST_CASE("what was summed, claimed and found is said in two lines") {
  CHECK(
      accuracy_text(Mode::automatic, full_report()) ==
      "mode auto, fp64, 15 diodes summed\n"
      "error at most 4 µm and 2e-05 of the amplitude claimed, at most 1.25 µm found in 1024 pixels, checked "
      "in 2.000 ms\n");
  AccuracyReport single;
  single.diodes = 1;
  CHECK(accuracy_text(Mode::reduced, single) == "mode reduced, fp32, 1 diode summed\n");
}

TEST_CASE("JSON has every figure of the report") {
  const auto json = accuracy_json(full_report());
  CHECK(json["precision"] == "fp64");
  CHECK(json["diodes"] == 15);
  CHECK(json["error_claimed_m"] == 4e-6);
  CHECK(json["error_found_m"] == 1.25e-6);
  CHECK(json["amplitude_error_claimed"] == 2e-5);
  CHECK(json["amplitude_error_found"].is_null());
  CHECK(json["checked_pixels"] == 1024);
  CHECK(json["check_ms"] == 2.0);
}

TEST_CASE("of several sensors times add up and the larger error counts") {
  Timing sum{{1.0, 2.0, 3.0}, {{"points", 0.5}}, full_report()};
  Timing other{{10.0, 20.0, 30.0}, {{"points", 1.0}, {"accumulate", 4.0}}, full_report()};
  other.accuracy.claimed_m = 7e-6;
  other.accuracy.found_m = std::nullopt;
  other.accuracy.diodes = 10;
  add(sum, other);
  CHECK(sum.frame_ms.median == 22.0);
  REQUIRE(sum.passes.size() == 2);
  CHECK(sum.passes[0].ms == 1.5);
  CHECK(sum.accuracy.claimed_m == 7e-6);
  CHECK_FALSE(sum.accuracy.found_m); // nothing is known of one of them
  CHECK(sum.accuracy.diodes == 15);
  CHECK(sum.accuracy.checked_pixels == 2048);
  CHECK(sum.accuracy.check_ms == 4.0);
}

TEST_CASE("frames are timed after one that is not") {
  int frames = 0;
  const Timing timing = time_frames([&](const std::string &label) {
    CHECK((label == "warming up") == (frames == 0));
    Measurement measurement;
    measurement.frame_ms = ++frames == 1 ? 1000.0 : frames;
    measurement.passes = {{"points", 0.5 * frames}};
    measurement.accuracy.diodes = static_cast<std::uint32_t>(frames);
    return measurement;
  });
  CHECK(frames == 1 + measured_frames);
  CHECK(timing.frame_ms.min == 2.0);
  CHECK(timing.frame_ms.max == 1.0 + measured_frames);
  CHECK(timing.frame_ms.median == 2.0 + (measured_frames - 1) / 2);
  CHECK(timing.passes.at(0).ms == 0.5 * timing.frame_ms.median);
  CHECK(timing.accuracy.diodes == 1 + measured_frames);
}
