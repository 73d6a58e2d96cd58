// The commands' output, and the files that they leave behind.

#include "tests/program/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

json run_json(const std::vector<std::string> &arguments) {
  const Run run = run_pmdsim(arguments);
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  return json::parse(run.output); // throws where anything stands beside the object
}

// The sensor `left` with two frequencies and three taps, and `right`, which is small_setup()'s.
std::string two_sensors() {
  const std::string setup = small_setup();
  const auto begin = setup.find("[{") + 1, end = setup.find("}],") + 1;
  const std::string right = with(setup.substr(begin, end - begin), "pmd", "right");
  const std::string left = with(with(right, "right", "left"), "[20e6]", "[20e6, 50e6], \"taps\": 3");
  return with(with(setup, "\"sensor\": \"pmd\"", "\"sensor\": \"left\""), setup.substr(begin, end - begin),
              left + ", " + right);
}

struct TwoSensors {
  Workspace work;
  std::string setup;

  TwoSensors() : setup((work.write("wall.gltf", wall_gltf()), work.write("setup.json", two_sensors()))) {}

  std::vector<std::string> arguments(const std::string &command) const {
    return {command, setup, "--device", "reference", "--format", "exr,npy,png,csv", "-o", work / "out"};
  }
  json report(const std::string &command) const {
    std::vector<std::string> with_json = arguments(command);
    with_json.emplace_back("--json");
    return run_json(with_json);
  }
  bool wrote(const std::string &file) const { return std::ranges::count(work.files("out"), file) == 1; }
};

void check_paper(const std::string &device) {
  const Workspace work;
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

} // namespace

TEST_CASE("the paper's figures 11 and 13") { check_paper("0"); }

TEST_CASE("the paper's figures 11 and 13 on the reference", "[long]") { check_paper("reference"); }

TEST_CASE("render --json names what scripts rely on, and every output exists", "[smoke]") {
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

TEST_CASE("lit is written unless shadows are off") {
  const auto device = GENERATE(as<std::string>{}, "0", "reference");
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string on = work.write("on.json", small_setup());
  const std::string off =
      work.write("off.json", with(small_setup(), "\"sensors\":", "\"shadows\": \"off\", \"sensors\":"));
  const auto files_of = [&](const std::string &command, const std::string &setup, const std::string &out) {
    run_json({command, setup, "--json", "--device", device, "--format", "npy,png,csv", "-o", work / out});
    return work.files(out);
  };
  const auto profile = [&](const std::string &out) {
    std::ifstream in(work / (out + "/pmd_0000.profile.csv"));
    std::string header;
    std::getline(in, header);
    return header;
  };
  const auto rendered = files_of("render", on, "on"), unshadowed = files_of("render", off, "off");
  CHECK(std::ranges::count(rendered, "pmd_0000.lit.npy") == 1);
  CHECK(std::ranges::count(rendered, "pmd_0000.lit.png") == 1);
  CHECK(profile("on").ends_with(",coverage,lit,triangle_id,object_id"));
  CHECK(rendered.size() == unshadowed.size() + 2);
  CHECK(profile("off").ends_with(",coverage,triangle_id,object_id"));
  const auto deformed = files_of("deform", on, "deformed");
  CHECK(std::ranges::count(deformed, "pmd_0000.lit.npy") == 1);
  CHECK(std::ranges::count(deformed, "pmd_0000.lit.png") == 0); // its pictures are of the deformation
}

TEST_CASE("the manifest lets anyone turn distances into points") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  run_json({"render", work.write("setup.json", small_setup()), "--json", "-o", work / "out"});
  std::ifstream in(work / "out/manifest.json");
  const json manifest = json::parse(in);
  CHECK(manifest["setup"]["sensors"][0]["samples"] == 1); // a default, filled in
  CHECK(manifest["setup"]["shadows"] == "auto");          // another
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
      const bool is_of_blender = entry.path().parent_path().filename() == "blender"; // with lights and coats
      std::istringstream lines(run.errors);
      for (std::string line; std::getline(lines, line);) // some shall show just that
        CHECK((line.ends_with("[beyond-ambiguity]") || (is_of_blender && line.find("[gltf-") != line.npos)));
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

TEST_CASE("render writes every sensor, every frequency and every tap") {
  const TwoSensors two;
  const json report = two.report("render");
  REQUIRE(report["frames"].size() == 2);
  CHECK(report["frames"][0]["sensor"] == "left");
  CHECK(report["frames"][1]["sensor"] == "right");
  for (const json &frame : report["frames"])
    for (const std::string output : frame["outputs"])
      CHECK(std::filesystem::is_regular_file(output));
  for (const char *file :
       {"left_0000.f0.amplitude.npy", "left_0000.f1.distance_m.npy", "left_0000.f1.tap2.npy",
        "left_0000.range_m.npy", "left_0000.f1.distance_m.png", "left_0000.exr", "right_0000.distance_m.npy",
        "right_0000.tap3.npy", "right_0000.phase_rad.png"}) {
    INFO(file);
    CHECK(two.wrote(file));
  }
  CHECK_FALSE(two.wrote("left_0000.f1.tap3.npy"));
  CHECK_FALSE(two.wrote("left_0000.f1.tap2.png"));
  std::ifstream in(two.work / "out/manifest.json");
  const json frames = json::parse(in)["frames"];
  REQUIRE(frames.size() == 2);
  CHECK(frames[0]["modulation_hz"] == json{20e6, 50e6});
  CHECK(frames[0]["taps"] == 3);
  CHECK(std::ranges::count(frames[1]["outputs"], "left_0000.exr") == 0);
  const std::string text = run_pmdsim(two.arguments("render")).output;
  CHECK(text.find("\nleft, frame 0") != std::string::npos);
  CHECK(text.find("distance at 50 MHz") != std::string::npos);
}

TEST_CASE("deform tells the first sensor's first frequency, and of all the others beside it") {
  const TwoSensors two;
  const json report = two.report("deform");
  REQUIRE(report["frames"].size() == 2);
  CHECK(report["frames"][0]["deformation_mm"].size() == 2);
  CHECK(report["frames"][1]["deformation_mm"].size() == 1);
  CHECK(report["deformation_mm"] == report["frames"][0]["deformation_mm"][0]);
  CHECK(report["deformation_mm"]["centre"].get<double>() == Approx(2.66).margin(0.01)); // 0.146^2 / 8 m
  for (const char *file : {"left_0000.f1.deformation_mm.npy", "left_0000.f1.deformation_mm.png",
                           "left_0000.f1.deformation_profile.png", "right_0000.deformation_profile.png"}) {
    INFO(file);
    CHECK(two.wrote(file));
  }
  const std::string text = run_pmdsim(two.arguments("deform")).output;
  CHECK(text.find("\nleft, 50 MHz") != std::string::npos);
}

TEST_CASE("check and bench tell of all sensors") {
  const TwoSensors two;
  const json check = run_json({"check", two.setup, "--json"});
  REQUIRE(check["sensors"].size() == 2);
  CHECK(check["sensors"][0]["common_ambiguity_m"].get<double>() == Approx(299792458.0 / 20e6));
  CHECK(check["ambiguity_m"] == check["sensors"][0]["ambiguity_m"][0]);
  CHECK(run_pmdsim({"check", two.setup}).output.find(" m at 50 MHz\n") != std::string::npos);
  CHECK(run_pmdsim({"bench", two.setup, "--device", "reference"})
            .output.find("warm frames of each of 2 sensors") != std::string::npos);
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
