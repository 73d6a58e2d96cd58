// Warnings in the terminal and in manifests, once a run, and as errors.

#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

// Of the wall, with the lens towards it or away from it.
json setup_looking_at(const json &look_at_m, int frames) {
  json setup = json::parse(small_setup());
  setup["sensors"][0]["pose"] = {{"position_m", {0, 0, 0}}, {"look_at_m", look_at_m}};
  setup["frames"] = {{"count", frames}, {"rate_hz", 10}};
  return setup;
}

std::size_t lines_of(const Run &run) {
  return static_cast<std::size_t>(std::ranges::count(run.errors, '\n'));
}

json manifest_of(const Workspace &work, const std::string &folder) {
  return json::parse(std::ifstream(work / (folder + "/manifest.json")));
}

} // namespace

TEST_CASE("What frames warn of is told once a run, in the terminal and in the manifest") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", setup_looking_at({0, 0, 1}, 3).dump());
  const Run run = run_pmdsim({"render", setup, "-o", work / "out", "--format", "npy"});
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  CHECK(lines_of(run) == 1);
  CHECK(run.errors.starts_with(
      "pmdsim: warning: sensor pmd, frame 0: nothing of the scene is in view: its centre "
      "lies 180 degrees off the optical axis and 2 m away; "));
  CHECK(run.errors.ends_with("; the same of 2 frames more, up to frame 2 [nothing-in-view]\n"));
  const json manifest = manifest_of(work, "out");
  REQUIRE(manifest["warnings"].size() == 1);
  CHECK(manifest["warnings"][0]["code"] == "nothing-in-view");
  CHECK(manifest["warnings"][0]["place"] == "sensor pmd, frame 0");
  CHECK(manifest["frames"][2]["warnings"][0]["place"] == "sensor pmd");
}

TEST_CASE("A frame without warnings is quiet, strict or not") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", setup_looking_at({0, 0, -1}, 1).dump());
  const Run run = run_pmdsim({"render", setup, "-o", work / "out", "--format", "npy", "--strict"});
  CHECK(run.exit_code == 0);
  CHECK(run.errors.empty());
  CHECK(manifest_of(work, "out")["warnings"] == json::array());
  CHECK(run_pmdsim({"check", setup, "--strict"}).exit_code == 0);
}

TEST_CASE("With --strict a frame that warns is refused, and nothing of it is left") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", setup_looking_at({0, 0, 1}, 2).dump());
  const Run run = run_pmdsim({"render", setup, "-o", work / "out", "--format", "npy", "--strict"});
  INFO(run.errors);
  CHECK(run.exit_code == 3);
  CHECK(lines_of(run) == 1);
  CHECK(run.errors.starts_with("pmdsim: error: sensor pmd, frame 0: nothing of the scene is in view"));
  CHECK_FALSE(std::filesystem::exists(work / "out"));
  const Run check = run_pmdsim({"check", setup, "--strict"});
  CHECK(check.exit_code == 3);
  CHECK(check.errors.find("[nothing-in-view]") != std::string::npos);
}

TEST_CASE("With --strict a setup that warns is refused before anything is measured") {
  const Workspace work;
  json wall = json::parse(wall_gltf());
  wall["extensionsUsed"] = {"ACME_fog", "ACME_rain"};
  work.write("wall.gltf", wall.dump());
  const std::string setup = work.write("setup.json", setup_looking_at({0, 0, -1}, 1).dump());
  for (const char *command : {"render", "check"}) {
    std::vector<std::string> arguments{command, setup, "--strict"};
    if (command == std::string("render"))
      arguments.insert(arguments.end(), {"-o", work / "out"});
    const Run run = run_pmdsim(arguments);
    INFO(run.errors);
    CHECK(run.exit_code == 3);
    CHECK(lines_of(run) == 1);
    CHECK(run.errors.find("\"ACME_fog\"") != std::string::npos);
    CHECK(run.errors.find("[gltf-extension]; and 1 warning more; ") != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(work / "out"));
  const Run told = run_pmdsim({"render", setup, "-o", work / "out", "--format", "npy"});
  CHECK(told.exit_code == 0);
  CHECK(lines_of(told) == 2);
  CHECK(manifest_of(work, "out")["warnings"][1]["place"] == "wall.gltf: /extensionsUsed");
}

TEST_CASE("Variants of a setup tell of the same once") {
  const Workspace work;
  json wall = json::parse(wall_gltf());
  wall["extensionsUsed"] = {"ACME_fog"};
  work.write("wall.gltf", wall.dump());
  const std::string setup = work.write("setup.json", setup_looking_at({0, 0, -1}, 1).dump());
  const std::string variants = work.write("variants.jsonl", "{\"sensors/0/focal_length_m\": 0.002}\n"
                                                            "{\"sensors/0/focal_length_m\": 0.003}\n");
  const Run run =
      run_pmdsim({"render", setup, "--variants", variants, "-o", work / "out", "--format", "npy"});
  INFO(run.errors);
  CHECK(run.exit_code == 0);
  CHECK(lines_of(run) == 1);
}

TEST_CASE("A frame most of which wraps is told of, and where all does, that units may be wrong") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  json setup = setup_looking_at({0, 0, -1}, 1);
  const auto rendered = [&](double modulation_hz) {
    setup["sensors"][0]["modulation_hz"] = {modulation_hz};
    return run_pmdsim(
        {"render", work.write("setup.json", setup.dump()), "-o", work / "out", "--format", "npy"});
  };
  const Run near = rendered(60e6); // 2.5 m
  CHECK(near.errors.empty());
  const Run far = rendered(100e6); // 1.5 m
  CHECK(lines_of(far) == 1);
  CHECK(far.errors.starts_with("pmdsim: warning: sensor pmd, frame 0: what is visible lies 2"));
  CHECK(far.errors.find("100 % of it beyond the ambiguity range of 1.49896 m: distances wrap; a lower") !=
        std::string::npos);
  CHECK(rendered(400e6).errors.find("centimetres") == std::string::npos); // often wrapped, but near
  CHECK(
      run_pmdsim({"deform", work / "setup.json", "-o", work / "deformed", "--format", "npy"}).errors.empty());
  work.write("wall.gltf", with(wall_gltf(), "\"mesh\": 0", "\"mesh\": 0, \"scale\": [100, 100, 100]"));
  const Run unit = rendered(20e6);
  CHECK(unit.errors.find("are the scene's lengths centimetres or millimetres?") != std::string::npos);
  CHECK(unit.errors.ends_with("[beyond-ambiguity]\n"));
}

TEST_CASE("A dark frame is told of") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  json setup = setup_looking_at({0, 0, -1}, 1);
  setup["illuminators"][0]["pose"] = {{"position_m", {0, 0, -4}},
                                      {"look_at_m", {0, 0, 0}}}; // behind the wall
  const Run run =
      run_pmdsim({"render", work.write("setup.json", setup.dump()), "-o", work / "out", "--format", "npy"});
  CHECK(run.exit_code == 0);
  CHECK(run.errors.ends_with("[all-dark]\n"));
  CHECK(lines_of(run) == 1);
}
