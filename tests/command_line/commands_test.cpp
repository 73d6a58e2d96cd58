// What the commands print and leave behind.

#include "tests/command_line/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

json run_json(const std::vector<std::string> &arguments) {
  const Run run = run_pmdsim(arguments);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output); // throws where anything stands beside the object
}

} // namespace

TEST_CASE("the paper's figures 11 and 13, on the device and on the reference") {
  const Workspace work;
  const auto device = GENERATE(as<std::string>{}, "0", "reference");
  const auto deformation = [&](const std::string &setup) {
    return run_json(
        {"deform", scene(setup), "--json", "--device", device, "-o", work / "out"})["deformation_mm"];
  };
  const json ring = deformation("paper_ring.json");
  CHECK(ring["mean"].get<double>() == Approx(2.6325).margin(0.002));
  CHECK(ring["min"].get<double>() == Approx(2.5299).margin(0.002));
  CHECK(ring["max"].get<double>() == Approx(2.6852).margin(0.002));
  CHECK(ring["centre"].get<double>() == Approx(2.6852).margin(0.002));
  const json half = deformation("paper_half_ring.json");
  CHECK(half["min"].get<double>() == Approx(-2.0136).margin(0.002));
  CHECK(half["max"].get<double>() == Approx(7.2559).margin(0.002));
  // On the axis all diodes of a ring are equally far: half of them measure what all of them do.
  CHECK(half["centre"].get<double>() == Approx(ring["centre"].get<double>()).margin(0.002));
}

TEST_CASE("render --json names what scripts rely on, and every output exists") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  const json report =
      run_json({"render", setup, "--json", "--format", "exr,npy,png,csv", "-o", work / "out"});
  CHECK(report["device"].is_string());
  CHECK(report["mode"] == "exact");
  const json &frame = report["frames"].at(0);
  CHECK(frame["sensor"] == "pmd");
  CHECK(frame["frame"] == 0);
  CHECK(frame["frame_ms"].get<double>() > 0.0);
  CHECK(frame["passes_ms"].contains("accumulate"));
  CHECK(frame.contains("error_claimed_m"));
  CHECK(frame.contains("error_found_m"));
  for (const std::string output : frame["outputs"])
    CHECK(std::filesystem::is_regular_file(output));
  for (const char *name :
       {"pmd_0000.exr", "pmd_0000.amplitude.npy", "pmd_0000.distance_m.png", "manifest.json"})
    CHECK(std::ranges::count(work.files("out"), name) == 1);
}

TEST_CASE("the manifest lets anyone turn distances into points") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  run_json({"render", work.write("setup.json", small_setup()), "--json", "-o", work / "out"});
  std::ifstream in(work / "out/manifest.json");
  const json manifest = json::parse(in);
  CHECK(manifest["setup"]["sensors"][0]["samples"] == 1); // a default, filled in
  const json &camera = manifest["frames"].at(0)["camera"];
  CHECK(camera["fx"].get<double>() == Approx(0.0018 / 45e-6));
  CHECK(camera["cx"].get<double>() == Approx(3.5));
  CHECK(camera["world_from_camera"].size() == 4);
}

TEST_CASE("check needs no device and says what follows from a setup") {
  const json report = run_json({"check", scene("paper_ring.json"), "--json"});
  CHECK(report["ambiguity_m"].get<double>() == Approx(299792458.0 / 40e6));
  CHECK(report["visible_range_m"][0].get<double>() == Approx(2.0).margin(1e-3));
  CHECK(report["visible_range_m"][1].get<double>() == Approx(2.02).margin(2e-3)); // the corners, sqrt(4.08) m
  const Run run = run_pmdsim({"check", scene("room.json")});
  CHECK(run.exit_code == 0);
  CHECK(run.output.find("240") != std::string::npos);
}

TEST_CASE("devices lists the reference beside what Vulkan offers") {
  const Run run = run_pmdsim({"devices"});
  CHECK(run.exit_code == 0);
  CHECK(run.output.find("reference") != std::string::npos);
}

TEST_CASE("every setup in scenes/ is valid") {
  int setups = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(PMDSIM_SCENES))
    if (entry.path().extension() == ".json") {
      const Run run = run_pmdsim({"check", entry.path().string()});
      INFO(entry.path() << ": " << run.errors);
      CHECK(run.exit_code == 0);
      CHECK((run.errors.empty() || run.errors.ends_with("distances wrap\n"))); // some shall show just that
      ++setups;
    }
  CHECK(setups >= 4);
}

TEST_CASE("bench SETUP checks its result and reports rates") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const json report = run_json({"bench", work.write("setup.json", small_setup()), "--json"});
  CHECK(report["device"].is_string());
  CHECK(report["driver"].is_string());
  CHECK(report["processor"].is_string());
  const json &row = report["results"].at(0);
  CHECK(row["name"] == "setup");
  CHECK(row["mode"] == "exact");
  CHECK(row["frame_ms"].get<double>() > 0.0);
  CHECK(row["interactions_per_s"].get<double>() > 0.0);
  CHECK(row["passes_ms"].contains("visibility"));
  CHECK(report.contains("ratios"));
}

TEST_CASE("interrupted, a run ends with 130 and leaves nothing half-written") {
  const Workspace work;
  // Long enough to be caught in the middle: the reference at 256 samples a pixel.
  const Run run = run_pmdsim(
      {"render", scene("paper_ring.json"), "--device", "reference", "--samples", "16", "-o", work / "out"},
      {.interrupt_after_ms = 1500});
  CHECK(run.exit_code == 130);
  CHECK(work.files("out").empty());
}

TEST_CASE("outputs are replaced, and -o may be nested and new") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  for (int i = 0; i < 2; ++i)
    CHECK(run_pmdsim({"render", setup, "-o", work / "a/b/c"}).exit_code == 0);
  CHECK(std::ranges::count(work.files("a/b/c"), "manifest.json") == 1);
}
