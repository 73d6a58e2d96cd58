// How exact frames shall be, on the real binary: what is refused, and what is told of what was done.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

struct SmallWall {
  Workspace work;
  std::string setup;

  SmallWall() : setup((work.write("wall.gltf", wall_gltf()), work.write("setup.json", small_setup()))) {}

  Run run(const std::string &command, const std::vector<std::string> &more) const {
    std::vector<std::string> arguments{command, setup};
    arguments.insert(arguments.end(), more.begin(), more.end());
    if (command != "bench")
      arguments.insert(arguments.end(), {"-o", work / "out"});
    return run_pmdsim(arguments);
  }

  json report(const std::string &command, std::vector<std::string> more) const {
    more.emplace_back("--json");
    const Run done = run(command, more);
    INFO(done.errors);
    REQUIRE(done.exit_code == 0);
    return json::parse(done.output);
  }

  json file(const std::string &name) const {
    std::ifstream in(work / ("out/" + name));
    return json::parse(in);
  }
};

} // namespace

TEST_CASE(
    "a frame of which some pixels cannot be promised tells which, or is refused where that is asked for") {
  const Workspace work;
  std::vector<std::string> arguments{"render",      PMDSIM_SCENES "/signal.json",
                                     "-o",          work / "out",
                                     "--max-error", "5.4um",
                                     "--precision", "fp32",
                                     "--format",    "npy",
                                     "--json"};
  const Run told = run_pmdsim(arguments);
  INFO(told.errors);
  REQUIRE(told.exit_code == 0);
  CHECK(std::ranges::count(told.errors, '\n') == 1);
  CHECK(told.errors.starts_with("pmdsim: warning: sensor pmd, frame 0: "));
  CHECK(json::parse(told.output)["frames"][0]["unpromised"] > 0);
  CHECK(std::ifstream(work / "out/pmd_0000.f0.error_bound_m.npy").good());
  arguments.emplace_back("--resume");
  CHECK(run_pmdsim(arguments).exit_code == 0); // as it is there
  arguments.emplace_back("--strict");
  check_refusal(run_pmdsim(arguments), 8, {"returns of pixels", "expected at most 0.0054 mm"});
  std::erase(arguments, "--resume");
  check_refusal(run_pmdsim(arguments), 8, {"returns of pixels", "expected at most 0.0054 mm"});
}

TEST_CASE("nothing is promised of frames whose taps are taken one after the other") {
  const Workspace work;
  const std::vector<std::string> arguments{
      "render", scene("motion.json"),         "-o",          work / "out", "--frames", "0:1",
      "--set",  "sensors/0/resolution=[8,6]", "--max-error", "10um"};
  const Run told = run_pmdsim(arguments);
  CHECK(told.exit_code == 0);
  CHECK(told.errors.find("nothing is claimed of their errors") != std::string::npos);
  std::vector<std::string> strict = arguments;
  strict.insert(strict.end(), {"--strict"});
  check_refusal(run_pmdsim(strict), 8, {"--strict: ", "nothing is claimed of their errors"});
}

TEST_CASE("what cannot be asked for is refused before anything is read") {
  const Workspace work;
  const auto refuse = [&](const std::vector<std::string> &more, const std::vector<std::string> &fragments) {
    std::vector<std::string> arguments{"render", work / "missing.json", "-o", work / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    check_refusal(run_pmdsim(arguments), 2, fragments);
  };
  for (const char *length : {"0.1", "mm", "-1mm", "0um", "1e-4um", "2e6m", "1 mm"})
    refuse({"--max-error", length}, {"--max-error: expected a length", "e.g. 0.1mm", length});
  refuse({"--max-amplitude-error", "2"}, {"--max-amplitude-error: expected a number above 0, at most 1"});
  refuse({"--mode", "fast"}, {"--mode"});
  refuse({"--mode", "exact", "--max-error", "1mm"}, {"--max-error: mode exact", "reduced or auto"});
  refuse({"--device", "reference", "--mode", "auto"}, {"--device reference: expected mode exact"});
  refuse({"--device", "reference", "--precision", "fp32"}, {"--device reference: expected precision fp64"});
}

TEST_CASE("the manifest and --json tell what was asked for and what it came to") {
  const SmallWall wall;
  const std::string command = GENERATE("render", "deform");
  const json frame = wall.report(command, {"--max-error", "50um"})["frames"].at(0);
  const json manifest = wall.file("manifest.json");
  CHECK(manifest["mode"] == "auto");
  CHECK(manifest["max_error_m"] == 5e-5);
  CHECK(manifest["max_amplitude_error"].is_null());
  for (const json &told : {frame, manifest["frames"].at(0)}) {
    CHECK(told["mode"] == "auto");
    for (const char *key : {"precision", "diodes", "error_claimed_m", "error_found_m",
                            "amplitude_error_claimed", "amplitude_error_found", "checked_pixels"}) {
      INFO(key);
      CHECK(told.contains(key));
    }
  }
  CHECK(frame.contains("check_ms"));
  wall.report(command, {});
  CHECK(wall.file("manifest.json")["mode"] == "exact");
  CHECK(wall.file("manifest.json")["max_error_m"].is_null());
}

TEST_CASE("the mode is told where it is not exact") {
  const SmallWall wall;
  const std::string command = GENERATE("render", "deform");
  CHECK(wall.run(command, {"--mode", "reduced"}).output.find("\nmode reduced, ") != std::string::npos);
  CHECK(wall.run(command, {}).output.find("mode ") == std::string::npos);
}

TEST_CASE("the reference sums in double") {
  const SmallWall wall;
  const json frame = wall.report("render", {"--device", "reference"})["frames"].at(0);
  CHECK(frame["mode"] == "exact");
  CHECK(frame["precision"] == "fp64");
  CHECK(frame["diodes"] == 16);
}

TEST_CASE("samples auto: 4 x 4 at most, and the setup as used says auto") {
  const SmallWall wall;
  const json frame = wall.report("render", {"--samples", "auto", "--format", "npy"});
  CHECK(wall.file("manifest.json")["setup"]["sensors"][0]["samples"] == "auto");
  const std::string in_setup =
      wall.work.write("auto.json", with(small_setup(), "0.0018,", "0.0018, \"samples\": \"auto\","));
  const Run check = run_pmdsim({"check", in_setup});
  CHECK(check.output.find("up to 4 x 4 samples a pixel") != std::string::npos);
  const std::string distances = wall.work / "out/pmd_0000.distance_m.npy";
  const auto bytes = [](const std::string &file) {
    std::ifstream in(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  // The reference takes all of them.
  wall.report("render", {"--samples", "auto", "--device", "reference", "--format", "npy"});
  const std::string automatic = bytes(distances);
  wall.report("render", {"--samples", "4", "--device", "reference", "--format", "npy"});
  CHECK(automatic == bytes(distances));
}

TEST_CASE("bench has a row a mode, and one where a mode is asked for", "[long]") {
  const SmallWall wall;
  const json all = wall.report("bench", {"--max-error", "0.1mm"});
  std::vector<std::string> modes;
  for (const json &row : all["results"]) {
    CHECK(row["name"] == "setup");
    CHECK(row["error_found_m"].get<double>() < 1e-4);
    CHECK(row.contains("error_claimed_m"));
    modes.push_back(row["mode"]);
  }
  CHECK(modes == std::vector<std::string>{"exact", "reduced", "auto"});
  CHECK(all["ratios"]["exact_frame_over_auto_frame"].get<double>() ==
        Approx(all["results"][0]["frame_ms"].get<double>() / all["results"][2]["frame_ms"].get<double>()));
  CHECK(all["ratios"].contains("exact_frame_over_reduced_frame"));
  const json one = wall.report("bench", {"--mode", "auto"});
  REQUIRE(one["results"].size() == 1);
  CHECK(one["results"][0]["mode"] == "auto");
  CHECK(one["ratios"].empty()); // there is no mode exact beside it
  CHECK(wall.report("bench", {"--device", "reference"})["results"].size() == 1);
}
