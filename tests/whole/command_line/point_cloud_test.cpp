// Point clouds that the program writes, read by the test's own reader.

#include "tests/program/refusal.h"
#include "tests/support/ply_file.h"
#include "tests/whole/command_line/run_fixture.h"

#include <cmath>

using namespace pmdsim::test;

namespace {

// The wall at 2 m, from the side: what a camera at (1, 0.5, 0) sees that looks at its middle.
struct WallFromTheSide {
  Workspace work;
  std::string setup;

  WallFromTheSide() {
    work.write("wall.gltf", wall_gltf());
    setup = work.write(
        "setup.json",
        with(
            small_setup(), "\"modulation_hz\"",
            R"("pose": {"position_m": [1, 0.5, 0], "look_at_m": [0, 0, -2], "up": [0, 1, 0]}, "modulation_hz")"));
  }

  Run run(const std::string &command, const std::vector<std::string> &more = {}) const {
    std::vector<std::string> all{command, setup, "--device", "reference", "-o", work / "out"};
    all.insert(all.end(), more.begin(), more.end());
    return run_pmdsim(all);
  }
};

} // namespace

TEST_CASE("points of a wall lie behind it by the deformation, and their true distances end on it") {
  const WallFromTheSide wall;
  const Run run = wall.run("deform", {"--format", "ply"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(wall.work.files("out") ==
        std::vector<std::string>{"0000.record.json", "manifest.json", "pmd_0000.ply", "run.json"});
  const PlyFile ply = parsed_ply(bytes_in(wall.work / "out/pmd_0000.ply"));
  REQUIRE(ply.vertices > 0);
  REQUIRE(ply.vertices < 64); // the wall does not fill the view
  for (std::size_t i = 0; i < ply.vertices; ++i) {
    const double from_lens[3]{ply["x"][i] - 1.0, ply["y"][i] - 0.5, ply["z"][i]};
    const double length_m = std::hypot(from_lens[0], from_lens[1], from_lens[2]);
    CHECK(length_m == Approx(ply["distance_m"][i]).epsilon(1e-6));
    if (ply["object_id"][i] == 0.0) // the pixel's centre sees the wall
      CHECK(from_lens[2] / length_m * ply["range_m"][i] == Approx(-2.0).epsilon(1e-5));
    CHECK(std::abs(1e3 * (ply["distance_m"][i] - ply["range_m"][i])) < 20.0);
    CHECK(ply["deformation_mm"][i] > 0.0);
    CHECK(ply["nz"][i] == 1.0);
    CHECK(std::abs(ply["nx"][i]) < 1e-12);
  }
}

TEST_CASE("points need a distance, and have what is wanted beside it") {
  const WallFromTheSide wall;
  check_refusal(wall.run("render", {"--format", "ply", "--channels", "amplitude,lit"}), 2,
                {"--format ply: points need a distance", "distance_m"});
  CHECK(wall.work.files("out").empty());
  REQUIRE(wall.run("render", {"--format", "ply", "--channels", "distance_m"}).exit_code == 0);
  CHECK(parsed_ply(bytes_in(wall.work / "out/pmd_0000.ply")).properties ==
        std::vector<std::string>{"x", "y", "z", "red", "green", "blue", "distance_m", "row", "column"});
}

TEST_CASE("pictures show the cloud and the objects") {
  const WallFromTheSide wall;
  REQUIRE(wall.run("render", {"--format", "png"}).exit_code == 0);
  const std::vector<std::string> files = wall.work.files("out");
  for (const char *name : {"pmd_0000.cloud.png", "pmd_0000.object_id.png"})
    CHECK(std::ranges::find(files, name) != files.end());
}

TEST_CASE("the manifest names the objects whose ids pixels have") {
  const WallFromTheSide wall;
  REQUIRE(wall.run("render", {"--format", "csv"}).exit_code == 0);
  const auto manifest = nlohmann::json::parse(bytes_in(wall.work / "out/manifest.json"));
  CHECK(manifest.at("objects") == nlohmann::json::parse(R"([{"id": 0, "name": "wall"}])"));
  const Run check = run_pmdsim({"check", wall.setup, "--json"});
  CHECK(nlohmann::json::parse(check.output).at("objects") == manifest.at("objects"));
  const Run text = run_pmdsim({"check", wall.setup});
  CHECK(text.output.find("objects                  1: 0 \"wall\"\n") != std::string::npos);
}

TEST_CASE("names of objects may hold anything") {
  const WallFromTheSide wall;
  const std::string wild = R"(a\"b\n\u0007\u001b[31m)";
  wall.work.write("wall.gltf", with(wall_gltf(), R"("name": "wall")", R"("name": ")" + wild + '"'));
  const Run text = run_pmdsim({"check", wall.setup});
  REQUIRE(text.exit_code == 0);
  CHECK(text.output.find("1: 0 \"a\\\"b\\n\\u0007\\u001b[31m\"\n") != std::string::npos);
  REQUIRE(wall.run("render", {"--format", "csv"}).exit_code == 0);
  const auto manifest = nlohmann::json::parse(bytes_in(wall.work / "out/manifest.json"));
  CHECK(manifest.at("objects").at(0).at("name") == "a\"b\n\a\x1b[31m");
}
