// pmdsim import-calibration on the real binary: from a calibration to a frame, and what it refuses.

#include "tests/program/program.h"
#include "tests/program/refusal.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace pmdsim::test;
using nlohmann::json;

namespace {

void check_refused(const std::vector<std::string> &arguments, int exit_code,
                   const std::vector<std::string> &fragments) {
  std::vector<std::string> all{"import-calibration"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  const Run run = run_pmdsim(all);
  check_refusal(run, exit_code, fragments);
}

void check_text_refused(const std::string &text, const std::vector<std::string> &fragments) {
  const Workspace work;
  check_refused({work.write("camera.yml", text)}, 3, fragments);
}

} // namespace

TEST_CASE("the printed sensor is one of a setup") {
  const Workspace work;
  const std::string calibration = work.write("camera.yml", opencv_calibration());
  for (const std::vector<std::string> &arguments :
       {std::vector<std::string>{"import-calibration", calibration},
        {"import-calibration", calibration, "--json"}}) {
    const Run run = run_pmdsim(arguments);
    INFO(run.errors);
    REQUIRE(run.exit_code == 0);
    CHECK(run.errors.starts_with("pmdsim: note: "));
    CHECK(std::ranges::count(run.errors, '\n') == 1);
    CHECK(run.errors.find("1e-05 m (--pixel-pitch-m") != std::string::npos);
    CHECK(run.errors.find("modulation_hz") != std::string::npos);
    json setup = json::parse(small_setup());
    setup["sensors"] = {json::parse(run.output)};
    setup["illuminators"][0].erase("pose");
    work.write("wall.gltf", wall_gltf());
    const Run check = run_pmdsim({"check", work.write("setup.json", setup.dump())});
    INFO(check.errors);
    CHECK(check.exit_code == 0);
  }
}

TEST_CASE("a message of ROS 2 is a calibration") {
  const Workspace work;
  const Run run = run_pmdsim({"import-calibration", work.write("camera_info.yaml", R"(header:
  stamp:
    sec: 0
    nanosec: 0
  frame_id: camera
height: 8
width: 12
distortion_model: ''
d: []
k: [40.0, 0.0, 5.5, 0.0, 40.0, 3.5, 0.0, 0.0, 1.0]
r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
p: [40.0, 0.0, 5.5, 0.0, 0.0, 40.0, 3.5, 0.0, 0.0, 0.0, 1.0, 0.0]
binning_x: 0
binning_y: 0
roi: {x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false}
---
)")});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  const json sensor = json::parse(run.output);
  CHECK(sensor["resolution"] == json({12, 8}));
  CHECK_FALSE(sensor.contains("distortion"));
  CHECK_FALSE(sensor.contains("chip"));
}

TEST_CASE("pitch and name are the user's where given") {
  const Workspace work;
  const Run run = run_pmdsim({"import-calibration", work.write("camera.yml", opencv_calibration()),
                              "--pixel-pitch-m", "45e-6", "--name", "left.1"});
  INFO(run.errors);
  REQUIRE(run.exit_code == 0);
  CHECK(run.errors.find("pitch") == std::string::npos);
  const json sensor = json::parse(run.output);
  CHECK(sensor["name"] == "left.1");
  CHECK(sensor["pixel_pitch_m"][0] == 45e-6);
  CHECK(sensor["focal_length_m"].get<double>() == Approx(40 * 45e-6).epsilon(1e-15));
}

TEST_CASE("calibrations that cannot be read end in one line") {
  const Workspace work;
  check_refused({work / "missing.yml"}, 3, {"missing.yml", "no such file"});
  check_refused({work.path().string()}, 3, {"is a directory"});
  check_text_refused("", {"camera.yml", "expected a calibration"});
  check_text_refused("<?xml version=\"1.0\"?><opencv_storage/>", {"camera.yml", "expected a calibration"});
  check_text_refused("a: [1, 2", {"camera.yml:1:", "not valid YAML"});
  check_text_refused("a: 1", {"camera.yml", "missing key image_size"});
  check_text_refused(std::string(200'000, '['), {"camera.yml", "nested too deep"});
  check_text_refused(with(opencv_calibration(), "40., 0.,", "40., 1e-3,"),
                     {"camera.yml:5:1", "camera_matrix", "skew"});
}

TEST_CASE("an alias bomb is not unrolled") {
  std::string bomb = "of_a: &a [1,1,1,1,1,1,1,1,1]\n";
  for (char name = 'b'; name <= 'z'; ++name) {
    const char inner = static_cast<char>(name - 1);
    bomb += std::string("of_") + name + ": &" + name + " [";
    for (int i = 0; i < 9; ++i)
      bomb += std::string(i == 0 ? "*" : ",*") + inner;
    bomb += "]\n";
  }
  check_text_refused(bomb + "image_size: [4, 4]\ncamera_matrix: *z\n",
                     {"camera.yml", "camera_matrix: expected a number"});
}

TEST_CASE("wrong command lines of import-calibration") {
  const Workspace work;
  const std::string calibration = work.write("camera.yml", opencv_calibration());
  check_refused({}, 2, {"FILE"});
  for (const char *pitch : {"0", "-1e-6", "nan", "inf", "wide"})
    check_refused({calibration, "--pixel-pitch-m", pitch}, 2, {"--pixel-pitch-m"});
  check_refused({calibration, "--name", "../pmd"}, 2, {"--name", "../pmd"});
}
