// The reports of check and bench on a setup, in text and in JSON.

#include "host/output/files/manifest.h"
#include "host/report/report.h"
#include "tests/program/program.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

using namespace pmdsim;
using namespace pmdsim::test;
using nlohmann::json;

namespace {

constexpr const char *nothing_hit =
    "nothing of the scene is in view: its centre lies 180 degrees off the optical axis and 2 m away; turn ";

std::string wall_behind_the_camera() {
  return with(wall_gltf(), R"("mesh": 0)", R"("mesh": 0, "rotation": [0, 1, 0, 0])");
}

} // namespace

TEST_CASE("check warns of a scene that is out of view, and of none that is seen") {
  const Workspace work;
  const std::string setup = work.write("setup.json", small_setup());

  work.write("wall.gltf", wall_behind_the_camera());
  const Run behind = run_pmdsim({"check", setup, "--json"});
  CHECK(behind.exit_code == 0);
  CHECK(behind.errors.find(nothing_hit) != std::string::npos);
  CHECK(json::parse(behind.output)["warnings"][0]["text"].get<std::string>().starts_with(nothing_hit));
  CHECK_THAT(json::parse(behind.output)["warnings"][0]["place"].get<std::string>(),
             Catch::EndsWith("setup.json: /sensors/0/pose"));

  work.write("wall.gltf", wall_gltf());
  const Run before = run_pmdsim({"check", setup, "--json"});
  CHECK(before.exit_code == 0);
  CHECK(before.errors.empty());
  CHECK(json::parse(before.output)["warnings"].empty());
}

TEST_CASE("check tells first that nothing is in view") {
  const Workspace work;
  json wall = json::parse(wall_behind_the_camera());
  wall["extensionsUsed"] = {"ACME_fog"};
  work.write("wall.gltf", wall.dump());
  const Run run = run_pmdsim({"check", work.write("setup.json", small_setup())});
  INFO(run.errors);
  CHECK(run.errors.find("[nothing-in-view]") < run.errors.find("[gltf-extension]"));
  CHECK(run.errors.find("[gltf-extension]") != std::string::npos);
}

TEST_CASE("check tells what the scene's camera at the sensor's node sees, where it is something else") {
  const Workspace work;
  json wall = json::parse(wall_gltf());
  wall["nodes"].push_back({{"name", "Camera"}, {"camera", 0}});
  wall["scenes"][0]["nodes"].push_back(1);
  const double height_rad = 2.0 * std::atan(0.5); // so that twice as wide is 90 degrees
  wall["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", height_rad}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
  work.write("wall.gltf", wall.dump());
  json setup = json::parse(small_setup());
  json &sensor = setup["sensors"][0];
  sensor["pose"] = {{"node", "Camera"}};
  const double pitch_m = sensor["pixel_pitch_m"][0], columns = sensor["resolution"][0];
  const auto checked = [&] { return run_pmdsim({"check", work.write("setup.json", setup.dump())}).output; };
  char like[64];
  std::snprintf(like, sizeof like, "\"focal_length_m\": %.4g is as wide\n", 0.5 * pitch_m * columns);
  CHECK_THAT(checked(), Catch::Contains("\n  of its camera node     90.000° x 53.130° (\"Camera\"); ") &&
                            Catch::Contains(like));
  sensor["focal_length_m"] = 0.5 * pitch_m * columns * 1.01;
  CHECK_THAT(checked(), !Catch::Contains("camera node"));
  wall["cameras"] = {{{"type", "orthographic"}}};
  work.write("wall.gltf", wall.dump());
  sensor["focal_length_m"] = 0.01;
  CHECK_THAT(checked(), !Catch::Contains("camera node"));
}

TEST_CASE("check tells of each illuminator where there are several") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  json setup = json::parse(small_setup());
  const std::string one = work.write("one.json", setup.dump());
  setup["illuminators"].push_back({{"name", "lamp"}, {"diodes", "monostatic"}, {"intensity_w_sr", 2}});
  const std::string two = work.write("two.json", setup.dump());

  CHECK_THAT(run_pmdsim({"check", one}).output,
             Catch::Contains(
                 "\n  of ring                16; x -143.19 to 143.19 mm, y -143.19 to 143.19 mm, z 0 mm, "
                 "axes along +z\n"));
  const Run text = run_pmdsim({"check", two});
  CHECK(text.output.find(
            "\n  of lamp                1, 2 W/sr on their axes, 25.1327 W of modulated power; x 0 mm, "
            "y 0 mm, z 0 mm, axes along +z\n") != std::string::npos);
  const json report = json::parse(run_pmdsim({"check", two, "--json"}).output);
  REQUIRE(report["illuminators"].size() == 2);
  CHECK(report["illuminators"][1]["name"] == "lamp");
  CHECK(report["illuminators"][1]["diodes"] == 1);
  CHECK(report["illuminators"][1]["places_m"] == json{{0, 0}, {0, 0}, {0, 0}});
  CHECK(report["illuminators"][1]["largest_lean_deg"] == 0);
  CHECK(report["illuminators"][1]["power_w"].get<double>() == Approx(25.1327).epsilon(1e-5));
  CHECK(report["diodes"] == report["illuminators"][0]["diodes"].get<int>() + 1);
}

TEST_CASE("check tells of shadows") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  json setup = json::parse(small_setup());
  const std::string on = work.write("on.json", setup.dump());
  setup["shadows"] = "off";
  const std::string off = work.write("off.json", setup.dump());

  CHECK(
      run_pmdsim({"check", on}).output.find("\nshadows                  on, 2 shapes that may cast them\n") !=
      std::string::npos);
  CHECK(run_pmdsim({"check", off})
            .output.find("\nshadows                  off, light passes through everything\n") !=
        std::string::npos);
  const json with = json::parse(run_pmdsim({"check", on, "--json"}).output);
  CHECK(with["shadows"] == "auto");
  CHECK(with["shadow_casters"] == 2);
  const json without = json::parse(run_pmdsim({"check", off, "--json"}).output);
  CHECK(without["shadows"] == "off");
  CHECK(without["shadow_casters"] == 0);
}

TEST_CASE("check tells of bounces and of the error that is asked for") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  json setup = json::parse(small_setup());
  const auto text_of = [&] { return run_pmdsim({"check", work.write("setup.json", setup.dump())}).output; };
  const auto json_of = [&] {
    return json::parse(run_pmdsim({"check", work.write("setup.json", setup.dump()), "--json"}).output);
  };
  CHECK(text_of().find("\nbounces                  0, light comes by one surface alone\n") !=
        std::string::npos);
  CHECK(json_of()["bounces"] == 0);
  CHECK(json_of()["bounce_error_m"] == 1e-3);
  setup["backscatter"] = "lambert";
  setup["bounces"] = 3;
  CHECK(text_of().find("\nbounces                  3, multipath within 1 mm is asked for: ") !=
        std::string::npos);
  setup["bounces"] = "all";
  setup["bounce_error"] = "0.5mm";
  CHECK(text_of().find("\nbounces                  all, multipath within 0.5 mm is asked for: ") !=
        std::string::npos);
  CHECK(json_of()["bounces"] == "all");
  CHECK(json_of()["bounce_error_m"] == 5e-4);
}

TEST_CASE("a setup whose light does not bounce takes no paths") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  for (const char *command : {"render", "deform"}) {
    const Run run = run_pmdsim({command, setup, "--device", "reference", "--paths", "100"});
    CHECK(run.exit_code == 2);
    CHECK(run.errors.find("--paths: no light bounces in ") != std::string::npos);
  }
}

TEST_CASE("what bounces took is told with its error") {
  BouncesReport report{2504, 100'000, 12, 8.2e-4};
  CHECK(bounces_text(report) == "multipath error at most 0.82 mm in 95 % of the pixels, estimated, from 2504 "
                                "elements and 100000 lines");
  CHECK(bounces_json(report) ==
        nlohmann::ordered_json::parse(R"({"elements": 2504, "lines": 100000, "products": 12,
                                                "claimed_m": 8.2e-4})"));
  report.claimed_m = std::nan("");
  CHECK(bounces_text(report) == "multipath from 2504 elements and 100000 lines");
  CHECK(json::parse(json_text(bounces_json(report)))["claimed_m"].is_null());
}

TEST_CASE("bench reports frames per second") {
  const Workspace work;
  work.write("wall.gltf", wall_gltf());
  const std::string setup = work.write("setup.json", small_setup());
  const Run run = run_pmdsim({"bench", setup, "--device", "reference", "--json"});
  REQUIRE(run.exit_code == 0);
  const json report = json::parse(run.output);
  const json &row = report["results"].at(0);
  CHECK(row["frames_per_s"].get<double>() == Approx(1e3 / row["frame_ms"].get<double>()));
  const std::string text = run_pmdsim({"bench", setup, "--device", "reference"}).output;
  CHECK(text.find("| setup | frame, ms | least to most | frames/s |") != std::string::npos);
  CHECK(text.find("\n| exact | ") != std::string::npos);
}

TEST_CASE("bench says that there is nothing to compare where the reference is dark") {
  const Workspace work;
  work.write("wall.gltf", wall_behind_the_camera());
  const std::string setup = work.write("setup.json", small_setup());
  const Run text = run_pmdsim({"bench", setup});
  CHECK(text.exit_code == 0);
  CHECK(text.output.find("nothing to compare") != std::string::npos);
  CHECK(text.output.find("nan") == std::string::npos);
  const Run run = run_pmdsim({"bench", setup, "--json"});
  REQUIRE(run.exit_code == 0);
  CHECK(json::parse(run.output)["results"].at(0)["error_found_m"].is_null());
}
