// Light that bounces, on the real binary: what is told of it, and what is refused.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

json shipped(const std::string &name) {
  std::ifstream in(std::string(PMDSIM_SCENES "/") + name + ".json");
  json setup = json::parse(in, nullptr, true, true);
  setup["scene"] = std::string(PMDSIM_SCENES "/") + setup["scene"].get<std::string>();
  setup["sensors"][0]["resolution"] = {16, 12};
  setup["sensors"][0]["pixel_pitch_m"] = {450e-6, 450e-6};
  return setup;
}

// The frame of a setup, or what was said in its place.
Run render(const Workspace &work, const json &setup, const std::vector<std::string> &more = {}) {
  std::vector<std::string> arguments{"render", work.write("setup.json", setup.dump()), "-o", work / "out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_pmdsim(arguments);
}

} // namespace

TEST_CASE("a frame with bounces tells what they took and how exact they are") {
  const Workspace work;
  const Run done = render(work, shipped("corner"), {"--json", "--format", "npy"});
  INFO(done.errors);
  REQUIRE(done.exit_code == 0);
  CHECK(done.errors.empty());
  const json frame = json::parse(done.output)["frames"][0];
  CHECK(frame["bounces"]["elements"] > 100);
  CHECK(frame["bounces"]["lines"] > 10'000);
  CHECK(frame["bounces"]["products"] > 2);
  CHECK(frame["bounces"]["claimed_m"] > 0.0);
  CHECK(frame["bounces"]["claimed_m"] <= 2e-3);
  CHECK(frame["passes_ms"].contains("bounces"));
  CHECK(frame["passes_ms"].contains("gather"));
  for (const std::string channel : {"multipath_m", "multipath_error_m", "indirect_share", "direct_amplitude",
                                    "direct_phase_rad", "direct_distance_m"})
    CHECK(std::filesystem::exists(work / ("out/pmd_0000." + channel + ".npy")));
}

TEST_CASE("a check tells how many elements bounces take and about how long") {
  const Workspace work;
  json setup = shipped("corner");
  const auto check = [&] {
    const Run done = run_pmdsim({"check", work.write("setup.json", setup.dump()), "--json"});
    REQUIRE(done.exit_code == 0);
    return json::parse(done.output);
  };
  const json asked = check();
  CHECK(asked["bounce_elements"] > 100);
  CHECK(asked["bounce_time_s"] > 0.0);
  setup["bounce_error"] = "0.5mm";
  CHECK(check()["bounce_elements"] > asked["bounce_elements"]);
  setup.erase("bounces");
  setup.erase("bounce_error");
  CHECK_FALSE(check().contains("bounce_elements"));
}

TEST_CASE("a frame without bounces has none of their channels") {
  const Workspace work;
  json setup = shipped("corner");
  setup.erase("bounces");
  const Run done = render(work, setup, {"--json", "--format", "npy"});
  REQUIRE(done.exit_code == 0);
  const json frame = json::parse(done.output)["frames"][0];
  CHECK_FALSE(frame.contains("bounces"));
  CHECK_FALSE(frame["passes_ms"].contains("gather"));
  CHECK_FALSE(std::filesystem::exists(work / "out/pmd_0000.multipath_m.npy"));
}

TEST_CASE("an error of what bounces that cannot be reached is refused with the one that was", "[long]") {
  const Workspace work;
  json setup = shipped("corner");
  setup["bounce_error"] = "1um";
  const Run refused = render(work, setup);
  check_refusal(refused, 8, {"mm in 95 % of the pixels", "0.001 mm"});
  CHECK_FALSE(std::filesystem::exists(work / "out/manifest.json"));
}

TEST_CASE("light that bounces without end is refused") {
  const Workspace work;
  std::ifstream in(PMDSIM_SCENES "/closed_box.gltf");
  json scene = json::parse(in);
  for (json &material : scene["materials"])
    material["extras"]["pmdsim_reflectivity"] = 1.0;
  json setup = shipped("closed_box");
  setup["scene"] = "closed.gltf";
  setup["bounces"] = "all";
  work.write("closed.gltf", scene.dump());
  const Run refused = render(work, setup);
  check_refusal(refused, 3, {"does not end"});
}

TEST_CASE("the reference renders what bounces, too") {
  const Workspace work;
  const Run done = render(work, shipped("corner"), {"--json", "--device", "reference", "--paths", "64"});
  INFO(done.errors);
  CHECK(done.exit_code == 0);
  CHECK(render(work, shipped("corner"), {"--paths", "64"}).exit_code == 2);
}
