// The reports on how exact frames are.

#include "host/bench/timing.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <catch2/catch.hpp>
#include <cmath>

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
  Measurement one, other;
  one.frame_ms = 2.0;
  one.passes = {{"points", 0.5}};
  one.accuracy = other.accuracy = full_report();
  other.frame_ms = 20.0;
  other.passes = {{"points", 1.0}, {"accumulate", 4.0}};
  other.accuracy.claimed_m = 7e-6;
  other.accuracy.found_m = std::nullopt;
  other.accuracy.diodes = 10;
  TimedFrame sum;
  add(sum, one);
  add(sum, other);
  CHECK(sum.frame_ms == 22.0);
  REQUIRE(sum.passes.size() == 2);
  CHECK(pass_ms(sum, "points") == 1.5);
  CHECK(pass_ms(sum, "accumulate") == 4.0);
  CHECK(std::isnan(pass_ms(sum, "resolve")));
  CHECK(sum.accuracy->claimed_m == 7e-6);
  CHECK_FALSE(sum.accuracy->found_m); // nothing is known of one of them
  CHECK(sum.accuracy->diodes == 15);
  CHECK(sum.accuracy->checked_pixels == 2048);
  CHECK(sum.accuracy->check_ms == 4.0);
}

TEST_CASE("a timing is the frames' medians, and of their accuracy the last") {
  std::vector<TimedFrame> frames;
  for (const double ms : {7.0, 1.0, 100.0}) {
    frames.push_back({ms, {{"points", ms / 4}, {"accumulate", ms / 2}}, AccuracyReport()});
    frames.back().accuracy->diodes = static_cast<std::uint32_t>(frames.size());
  }
  const Timing timing = timing_of(frames);
  CHECK(timing.frame_ms.min == 1.0);
  CHECK(timing.frame_ms.median == 7.0);
  CHECK(timing.frame_ms.max == 100.0);
  REQUIRE(timing.passes.size() == 2);
  CHECK(timing.passes[0].name == "points");
  CHECK(timing.passes[0].ms == 1.75);
  CHECK(timing.passes[1].ms == 3.5);
  CHECK(timing.passes_explain == 0.75);
  CHECK(timing.accuracy.diodes == 3);
}
