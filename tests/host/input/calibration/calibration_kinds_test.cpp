// Calibrations of parts of a chip, of several cameras, and of other tools than OpenCV and ROS.

#include "tests/host/input/calibration/calibration_texts.h"

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;

TEST_CASE("ROS's binning and region of interest") {
  const std::string roi = "  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n";
  const std::string part =
      replaced(ros2_message, roi, "  x_offset: 40\n  y_offset: 20\n  height: 100\n  width: 201\n");
  Calibration c = calibration_of(part);
  CHECK(c.resolution == glm::uvec2(201, 100));
  CHECK(c.fx == 300.0);
  CHECK(c.cx == 160.5 - 40.0);
  CHECK(c.cy == 120.5 - 20.0);
  c = calibration_of(
      replaced(replaced(part, "binning_x: 0", "binning_x: 2"), "binning_y: 0", "binning_y: 4"));
  CHECK(c.resolution == glm::uvec2(100, 25));
  CHECK(c.binning == glm::uvec2(2, 4));
  CHECK(c.fx == 150.0);
  CHECK(c.fy == 301.0 / 4.0);
  // The centre of the first binned pixel lies between the centres of full pixels 0 and 1, and of 0 to 3.
  CHECK(c.cx == (160.5 - 40.0 - 0.5) / 2.0);
  CHECK(c.cy == (120.5 - 20.0 - 1.5) / 4.0);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == -0.3);

  CHECK_THAT(
      calibration_error_of(replaced(part, "width: 201", "width: 300")),
      EndsWith("roi: expected a region within the image of 320 x 240 pixels, found 300 x 100 from column "
               "40, row 20 on"));
  CHECK_THAT(calibration_error_of(replaced(part, "width: 201", "width: 0")),
             Contains("roi: expected a region within the image"));
  CHECK_THAT(calibration_error_of(replaced(part, "binning_x: 0", "binning_x: 1.5")),
             EndsWith("binning_x: expected a whole number from 0 to 64, found 1.5"));
  CHECK_THAT(calibration_error_of(
                 replaced(replaced(part, "width: 201", "width: 3"), "binning_x: 0", "binning_x: 4")),
             Contains("expected at least one binned pixel of 4 x 1, found a region of 3 x 100"));
}

namespace {

constexpr const char *kalibr = R"(cam0:
  camera_model: pinhole
  intrinsics: [461.6, 460.3, 362.7, 246.1]
  distortion_model: radtan
  distortion_coeffs: [-0.27, 0.06, 0.0001, 0.0002]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
cam1:
  camera_model: pinhole
  intrinsics: [460.0, 459.0, 370.0, 250.0]
  distortion_model: equidistant
  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]
  resolution: [752, 480]
  T_cn_cnm1:
  - [0.0, -1.0, 0.0, -0.11]
  - [1.0, 0.0, 0.0, 0.02]
  - [0.0, 0.0, 1.0, 0.03]
  - [0.0, 0.0, 0.0, 1.0]
)";

} // namespace

TEST_CASE("Kalibr's cameras, one after the other") {
  const Calibration first = calibration_of(kalibr), second = calibration_of(kalibr, "cam1");
  CHECK(first.name == "cam0");
  CHECK(first.cameras == std::vector<std::string>{"cam0", "cam1"});
  CHECK(first.resolution == glm::uvec2(752, 480));
  CHECK(first.fy == 460.3);
  CHECK(first.cx == 362.7);
  CHECK(std::get<BrownConrady>(first.distortion).p2 == 0.0002);
  CHECK(first.first_from_camera == Pose());
  CHECK(second.name == "cam1");
  CHECK(std::get<Fisheye>(second.distortion).k4 == 0.04);
  // The second camera's own origin: R c + t = 0.
  const glm::dvec3 origin_m = second.first_from_camera.translation_m;
  CHECK(origin_m == glm::dvec3(-0.02, -0.11, -0.03));
  CHECK(second.first_from_camera.direction({1, 0, 0}) == glm::dvec3(0, -1, 0));
  CHECK_THAT(calibration_error_of(kalibr, "cam2"),
             EndsWith("--camera: expected cam0 or cam1, found \"cam2\""));
  CHECK_THAT(calibration_error_of(replaced(kalibr, "camera_model: pinhole", "camera_model: omni")),
             Contains("camera.yml:2:3: camera_model: expected pinhole, the only camera model of Kalibr's") &&
                 EndsWith("found \"omni\""));
  CHECK_THAT(calibration_error_of(replaced(kalibr, "radtan", "fov")),
             EndsWith("expected radtan, equidistant or none, found \"fov\""));
  CHECK_THAT(
      calibration_error_of(replaced(kalibr, "[0.0, 0.0, 1.0, 0.03]", "[0.0, 0.0, 2.0, 0.03]"), "cam1"),
      EndsWith(
          "T_cn_cnm1: expected a rotation and a translation, found a matrix that scales, shears or mirrors"));
  CHECK_THAT(calibration_error_of(ros_yaml, "cam1"),
             EndsWith("--camera: the file has one camera, found \"cam1\""));
}

TEST_CASE("OpenCV's pairs of cameras") {
  const std::string pair = "image_size: [320, 240]\n"
                           "M1: [300,0,160,0,301,120,0,0,1]\nD1: [0.1,0,0,0,0]\n"
                           "M2: [310,0,161,0,311,121,0,0,1]\nD2: [0.2,0,0,0,0]\n"
                           "R: [1,0,0,0,1,0,0,0,1]\nT: [-0.12, 0.01, 0.02]\n";
  CHECK(calibration_of(pair).fy == 301.0);
  const Calibration second = calibration_of(pair, "2");
  CHECK(second.fx == 310.0);
  CHECK(std::get<BrownConrady>(second.distortion).k1 == 0.2);
  CHECK(second.first_from_camera.translation_m == glm::dvec3(0.12, -0.01, -0.02));
}

TEST_CASE("Intrinsics as Open3D, RealSense and others write them") {
  Calibration c = calibration_of(
      R"({"width": 640, "height": 480, "intrinsic_matrix": [600, 0, 0, 0, 601, 0, 320, 240, 1]})");
  CHECK(c.fy == 601.0);
  CHECK(c.cx == 320.0);
  CHECK(c.cy == 240.0);
  c = calibration_of(R"({"width": 640, "height": 480, "fx": 600, "fy": 601, "ppx": 320, "ppy": 240,
               "model": "Brown Conrady", "coeffs": [0.1, 0.2, 0.3, 0.4, 0.5]})");
  CHECK(c.cy == 240.0);
  CHECK(std::get<BrownConrady>(c.distortion).k3 == 0.5);
  c = calibration_of("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\nk1: 0.1\np2: 0.4\n");
  CHECK(std::get<BrownConrady>(c.distortion).p2 == 0.4);
  CHECK(std::holds_alternative<std::monostate>(
      calibration_of("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\n").distortion));
  CHECK_THAT(calibration_error_of("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\nk5: 0.1\n"),
             EndsWith("camera.yml:7:1: k5: k5: expected 0: pmdsim has no rational terms, found 0.1"));
}
