// What is odd about a frame, by channels of a few pixels.

#include "engine/model/error.h"
#include "host/output/files/frame_warnings.h"
#include "host/report/frame_findings.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace pmdsim;

namespace {

using Codes = std::vector<std::string>;

Measurement lit_frame() {
  Measurement frame;
  frame.coverage = {0.0f, 1.0f, 0.5f};
  frame.returns.resize(1);
  frame.returns[0].amplitude = {0.0f, 0.0f, 1e-9f};
  return frame;
}

std::vector<Warning> warnings_of(const Measurement &frame, const Accuracy &asked = {},
                                 const Bounces &bounces = {}) {
  Setup setup;
  setup.bounces = bounces;
  return frame_warnings(setup, Sensor{}, frame, asked);
}

Codes codes_of(const std::vector<Warning> &warnings) {
  Codes codes;
  for (const Warning &warning : warnings)
    codes.push_back(warning.code);
  return codes;
}

} // namespace

TEST_CASE("A frame that sees nothing, and one that is dark, are told") {
  CHECK(warnings_of(lit_frame()).empty());
  Measurement frame = lit_frame();
  frame.returns[0].amplitude[2] = 0.0f;
  CHECK(codes_of(warnings_of(frame)) == Codes{"all-dark"});
  CHECK(warnings_of(frame)[0].place == "sensor pmd");
  frame.has_electrons = true; // whose amplitude is noise, and whose light is not asked for
  CHECK(warnings_of(frame).empty());
  frame.mean_radiance = {0.0f, 0.0f, 0.0f};
  CHECK(codes_of(warnings_of(frame)) == Codes{"all-dark"});
  frame.coverage = {0.0f, 0.0f, 0.0f};
  CHECK(codes_of(warnings_of(frame)) == Codes{"nothing-in-view"});
  Setup empty;
  empty.warnings = {{"empty-scene", "", ""}};
  CHECK(frame_warnings(empty, Sensor{}, frame, {}).empty()); // which says it all
  frame.coverage.clear();                                    // not asked for
  CHECK(warnings_of(frame).empty());
}

TEST_CASE("Frames are told of where most of what they see wraps in all frequencies together") {
  Measurement frame = lit_frame();
  Setup setup;
  Sensor sensor;
  sensor.modulation_hz = {20e6}; // 7.49 m
  const auto told = [&] { return codes_of(frame_warnings(setup, sensor, frame, {})); };
  frame.range_m = {NAN, 7.0f, 8.0f, 9.0f};
  CHECK(told() == Codes{"beyond-ambiguity"});
  CHECK_THAT(
      frame_warnings(setup, sensor, frame, {})[0].text,
      Catch::StartsWith("what is visible lies 7 m to 9 m away, 66.7 % of it beyond the ambiguity range of "
                        "7.49481 m: distances wrap; a lower"));
  sensor.modulation_hz = {20e6, 30e6}; // 15 m together
  CHECK(told().empty());
  sensor.modulation_hz = {20e6};
  sensor.unwrap_range_m = 10.0;
  CHECK(told().empty());
  sensor.unwrap_range_m = Sensor().unwrap_range_m;
  frame.range_m = {NAN, 7.0f, 7.2f, 9.0f};
  CHECK(told().empty());
  frame.range_m = {700.0f, 900.0f};
  CHECK_THAT(frame_warnings(setup, sensor, frame, {})[0].text,
             Catch::Contains("centimetres or millimetres?"));
  setup.warnings = {{"scene-in-millimetres", "", ""}}; // which says it all
  CHECK(told().empty());
}

TEST_CASE("Saturated pixels are told where they are more than one in a hundred") {
  Measurement frame = lit_frame();
  frame.returns[0].share_saturated = 0.01;
  CHECK(warnings_of(frame).empty());
  frame.returns[0].share_saturated = 0.015;
  CHECK(codes_of(warnings_of(frame)) == Codes{"saturated"});
  CHECK_THAT(warnings_of(frame)[0].text, Catch::StartsWith("a tap was full in 1.5 % of the pixels"));
}

TEST_CASE("A claim is told where it is more than twice what was asked for") {
  Measurement frame = lit_frame();
  Accuracy asked;
  asked.mode = Mode::automatic;
  asked.max_error_m = 1e-3;
  frame.accuracy.claimed_m = 1.9e-3;
  CHECK(warnings_of(frame, asked).empty());
  frame.accuracy.claimed_m = 2.1e-3;
  CHECK(codes_of(warnings_of(frame, asked)) == Codes{"claim-above-budget"});
  frame.accuracy = {};
  frame.bounces = BouncesReport{.claimed_m = 3e-3};
  const Bounces bounces{1, 1e-3};
  CHECK(codes_of(warnings_of(frame, {}, bounces)) == Codes{"claim-above-budget"});
  frame.accuracy.unpromised = 5;
  CHECK(codes_of(warnings_of(frame, asked, bounces)) == Codes{"claim-above-budget", "error-above-asked"});
}

TEST_CASE("Warnings of many frames are told once, with the first frame and how many more there are") {
  FrameWarnings warnings;
  const Warning dark{"all-dark", "sensor pmd", "it is dark"};
  warnings.add(dark, 3);
  warnings.add(dark, 3); // the other light of the same frame
  CHECK(warnings.merged() == std::vector<Warning>{{"all-dark", "sensor pmd, frame 3", "it is dark"}});
  warnings.add({"all-dark", "sensor left", "it is dark"}, 3);
  warnings.add(dark, 4);
  warnings.add(dark, 9);
  CHECK(warnings.merged() == std::vector<Warning>{{"all-dark", "sensor pmd, frame 3",
                                                   "it is dark; the same of 2 frames more, up to frame 9"},
                                                  {"all-dark", "sensor left, frame 3", "it is dark"}});
}

TEST_CASE("Warnings as errors tell the first and how many there are") {
  CHECK_NOTHROW(refuse_warnings({}));
  const Warning scene{"empty-scene", "a.json: /scene", "nothing"},
      error{"error-above-asked", "sensor pmd", "off"};
  const auto refusal = [](const std::vector<Warning> &warnings) {
    try {
      refuse_warnings(warnings);
    } catch (const Error &refused) {
      return refused;
    }
    return Error(ExitCode::done, "");
  };
  CHECK(refusal({scene}).code() == ExitCode::input);
  CHECK(refusal({error}).code() == ExitCode::accuracy);
  CHECK(refusal({scene}).where().file == "a.json");
  CHECK(refusal({scene}).where().place == "/scene");
  CHECK(std::string(refusal({scene, error, scene}).what()) ==
        "a.json: /scene: nothing [empty-scene]; and 2 warnings more; strict makes warnings errors");
}
