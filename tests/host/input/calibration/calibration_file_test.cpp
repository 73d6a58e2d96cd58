// Calibrations as tools write them, and what is wrong with them.

#include "host/input/calibration/calibration_file.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>

using namespace pmdsim;
using namespace pmdsim::test;
using Catch::Contains;
using Catch::EndsWith;

namespace {

// As OpenCV's camera calibration tutorial writes it.
constexpr const char *opencv_yaml = R"(%YAML:1.0
---
calibration_time: "Sat 02 Mar 2019 12:00:00"
nr_of_frames: 2
image_width: 640
image_height: 480
board_width: 9
square_size: 5.0000000000000000e+01
# flags:  +fix_principal_point +zero_tangent_dist
flags: 12
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 6.5e+02, 0., 3.1950000000000000e+02, 0.,
       6.6e+02, 2.3950000000000000e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -4.1e-01, 5.0e-01, 1.0e-03, -2.0e-03, -5.7e-01 ]
avg_reprojection_error: 3.8e-01
per_view_reprojection_errors: !!opencv-matrix
   rows: 2
   cols: 1
   dt: f
   data: [ 3.8e-01, .Nan ]
)";

constexpr const char *ros_yaml = R"(image_width: 320
image_height: 240
camera_name: narrow_stereo/left
camera_matrix:
  rows: 3
  cols: 3
  data: [300, 0, 160.5, 0, 301, 120.5, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.3, 0.1, 0.001, 0.002, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [300, 0, 160, 0, 0, 300, 120, 0, 0, 0, 1, 0]
)";

// As ROS 2's `ros2 topic echo --once /camera_info` prints it.
constexpr const char *ros2_message = R"(header:
  stamp:
    sec: 1700000000
    nanosec: 123456789
  frame_id: camera_optical_frame
height: 240
width: 320
distortion_model: plumb_bob
d:
- -0.3
- 0.1
- 0.001
- 0.002
- 0.0
k:
- 300.0
- 0.0
- 160.5
- 0.0
- 301.0
- 120.5
- 0.0
- 0.0
- 1.0
r:
- 1.0
- 0.0
- 0.0
- 0.0
- 1.0
- 0.0
- 0.0
- 0.0
- 1.0
p:
- 300.0
- 0.0
- 160.0
- 0.0
- 0.0
- 300.0
- 120.0
- 0.0
- 0.0
- 0.0
- 1.0
- 0.0
binning_x: 0
binning_y: 0
roi:
  x_offset: 0
  y_offset: 0
  height: 0
  width: 0
  do_rectify: false
---
)";

Calibration read(const std::string &text, const std::string &camera = {}) {
  const TemporaryFolder folder;
  return read_calibration(folder.write("camera.yml", text), camera);
}

std::string error_of(const std::string &text, const std::string &camera = {}) {
  return input_error_of([&] { read(text, camera); });
}

std::string with(std::string text, const std::string &from, const std::string &to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string ros_with(const std::string &from, const std::string &to) { return with(ros_yaml, from, to); }

// A calibration in few lines.
std::string brief(const std::string &distortion, const std::string &matrix = "[300,0,160,0,300,120,0,0,1]") {
  return "image_size: [320, 240]\nK: " + matrix + "\nD: " + distortion + "\n";
}

} // namespace

TEST_CASE("What OpenCV's calibration writes as YAML") {
  for (const std::string &text : {std::string(opencv_yaml), with(opencv_yaml, "---\n", ""),
                                  with(opencv_yaml, "%YAML:1.0\n---\n", "")}) {
    const Calibration c = read(text);
    CHECK(c.name.empty());
    CHECK(c.resolution == glm::uvec2(640, 480));
    CHECK(c.fx == 650.0);
    CHECK(c.fy == 660.0);
    CHECK(c.cx == 319.5);
    CHECK(c.cy == 239.5);
    const auto &d = std::get<BrownConrady>(c.distortion);
    CHECK(d.k1 == -0.41);
    CHECK(d.k2 == 0.5);
    CHECK(d.p1 == 0.001);
    CHECK(d.p2 == -0.002);
    CHECK(d.k3 == -0.57);
    CHECK(c.tau_x_rad == 0.0);
    CHECK(c.tau_y_rad == 0.0);
  }
}

TEST_CASE("What OpenCV writes as JSON") {
  const Calibration c = read(R"({
	"image_Width": 640, "image_Height": 480,
	"Camera_Matrix": {
		"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
		"data": [ 650.0, 0.0, 319.5, 0.0, 660.0, 239.5, 0.0, 0.0, 1.0 ]
	},
	"Distortion_Coefficients": {
		"type_id": "opencv-matrix", "rows": 1, "cols": 4, "dt": "d",
		"data": [ 0.1, 0.2, 0.3, 0.4 ]
	}
})");
  CHECK(c.resolution == glm::uvec2(640, 480));
  CHECK(c.fy == 660.0);
  CHECK(std::get<BrownConrady>(c.distortion).p2 == 0.4);
  CHECK(std::get<BrownConrady>(c.distortion).k3 == 0.0);
}

TEST_CASE("What ROS writes") {
  const Calibration c = read(ros_yaml);
  CHECK(c.name == "narrow_stereo/left");
  CHECK(c.resolution == glm::uvec2(320, 240));
  CHECK(c.fx == 300.0);
  CHECK(c.cy == 120.5);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == -0.3);
}

TEST_CASE("What ROS 2 prints of a message") {
  for (const std::string &text : {std::string(ros2_message), with(ros2_message, "---\n", "")}) {
    const Calibration c = read(text);
    CHECK(c.name.empty());
    CHECK(c.resolution == glm::uvec2(320, 240));
    CHECK(c.fx == 300.0);
    CHECK(c.fy == 301.0);
    CHECK(c.cx == 160.5);
    CHECK(c.cy == 120.5);
    const auto &d = std::get<BrownConrady>(c.distortion);
    CHECK(d.k1 == -0.3);
    CHECK(d.k2 == 0.1);
    CHECK(d.p1 == 0.001);
    CHECK(d.p2 == 0.002);
    CHECK(d.k3 == 0.0);
  }
}

TEST_CASE("What ROS 2 prints of a camera without distortion") {
  const std::string numbers = "d:\n- -0.3\n- 0.1\n- 0.001\n- 0.002\n- 0.0\n";
  const std::string none = with(ros2_message, numbers, "d: []\n");
  const std::string zeros = with(ros2_message, numbers, "d:\n- 0.0\n- 0.0\n- 0.0\n- 0.0\n- 0.0\n");
  for (const std::string &text : {none, zeros}) {
    CHECK(std::holds_alternative<std::monostate>(read(text).distortion));
    const Calibration c = read(with(text, "distortion_model: plumb_bob", "distortion_model: ''"));
    CHECK(std::holds_alternative<std::monostate>(c.distortion));
    CHECK(c.fy == 301.0);
  }
  CHECK_THAT(error_of(with(ros2_message, "plumb_bob", "''")),
             EndsWith("camera.yml:9:1: d: expected no coefficients but 0 beside an empty distortion_model"));
}

TEST_CASE("Matrices may be lists of rows, and keys short") {
  const Calibration c = read(brief("[[0.1, 0, 0, 0, 0]]", "[[300, 0, 160], [0, 310, 120], [0, 0, 1]]"));
  CHECK(c.resolution == glm::uvec2(320, 240));
  CHECK(c.fy == 310.0);
  CHECK(c.cy == 120.0);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == 0.1);
}

TEST_CASE("Zeros are no distortion") {
  CHECK(std::holds_alternative<std::monostate>(read(brief("[0, 0, 0, 0]")).distortion));
  CHECK(std::holds_alternative<std::monostate>(
      read(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]")).distortion));
}

TEST_CASE("An empty list is no distortion") {
  for (const char *list : {"[]", "{rows: 0, cols: 0, data: []}", "{data: []}"}) {
    const std::string text = brief(list);
    CHECK(std::holds_alternative<std::monostate>(read(text).distortion));
    CHECK(std::holds_alternative<std::monostate>(read(text + "distortion_model: \"\"").distortion));
    CHECK_THAT(error_of(text + "distortion_model: equidistant"),
               EndsWith("D: expected the fisheye's k1 to k4, found 0 numbers"));
  }
}

TEST_CASE("A fisheye is one by OpenCV's flag or by the model's name") {
  const std::string four = brief("[0.1, 0.2, 0.3, 0.4]");
  CHECK(std::holds_alternative<BrownConrady>(read(four).distortion));
  CHECK(std::holds_alternative<BrownConrady>(read(four + "distortion_model: plumb_bob").distortion));
  CHECK(std::holds_alternative<BrownConrady>(read(four + "fisheye_model: 0").distortion));
  for (const char *line : {"fisheye_model: 1", "distortion_model: fisheye", "distortion_model: equidistant",
                           "distortion_model: \"kannala_brandt\""}) {
    const auto d = std::get<Fisheye>(read(four + line).distortion);
    CHECK(d.k1 == 0.1);
    CHECK(d.k4 == 0.4);
  }
  CHECK_THAT(error_of(brief("[0, 0, 0, 0, 0]") + "fisheye_model: 1"),
             EndsWith("D: expected the fisheye's k1 to k4, found 5 numbers"));
  CHECK_THAT(error_of(four + "fisheye_model: 2"), EndsWith("fisheye_model: expected 0 or 1, found 2"));
  CHECK_THAT(error_of(four + "distortion_model: omni"),
             Contains("camera.yml:4:1: distortion_model: expected plumb_bob,") && EndsWith("found \"omni\""));
}

TEST_CASE("OpenCV's tilt is read, its rational and thin prism terms are refused by name") {
  const Calibration c = read(brief("[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.02, -0.03]"));
  CHECK(c.tau_x_rad == 0.02);
  CHECK(c.tau_y_rad == -0.03);
  CHECK_THAT(error_of(brief("[0.1, 0, 0, 0, 0, 0, 0.5, 0]")),
             EndsWith("camera.yml:3:1: D: k5: expected 0: pmdsim has no rational terms, found 0.5"));
  CHECK_THAT(error_of(brief("[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2]")),
             EndsWith("D: s4: expected 0: pmdsim has no thin prism terms, found 2"));
  CHECK_THAT(error_of(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1.6]")),
             EndsWith("D: tauY: expected a tilt within 89 degrees, found 1.6 rad"));
}

TEST_CASE("Camera matrices that are none") {
  const auto error = [](const std::string &matrix) { return error_of(brief("[0, 0, 0, 0]", matrix)); };
  CHECK_THAT(error("[300,0.5,160,0,300,120,0,0,1]"),
             EndsWith("camera.yml:2:1: K: expected 0 in row 1, column 2: pmdsim has no skew, found 0.5"));
  CHECK_THAT(error("[300,0,160,0,300,120,0,0,2]"), EndsWith("K: expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]"));
  CHECK_THAT(error("[300,0,160,1,300,120,0,0,1]"), EndsWith("K: expected [fx, 0, cx, 0, fy, cy, 0, 0, 1]"));
  CHECK_THAT(error("[0,0,160,0,300,120,0,0,1]"), EndsWith("K: expected fx and fy above 0, found 0 and 300"));
  CHECK_THAT(error("[300,0,160,0,-300,120,0,0,1]"), Contains("expected fx and fy above 0"));
  CHECK_THAT(error("[300,0,160]"), EndsWith("K: expected 3 x 3 numbers, found 3"));
  CHECK_THAT(error("[300,0,160,0,300,120,0,0,1,0]"), EndsWith("K: expected at most 9 numbers"));
  CHECK_THAT(error("[.Nan,0,160,0,300,120,0,0,1]"), EndsWith("K: expected a finite number, found \".Nan\""));
  CHECK_THAT(error("[1e999,0,160,0,300,120,0,0,1]"), EndsWith("found \"1e999\""));
  CHECK_THAT(error("[inf,0,160,0,300,120,0,0,1]"), EndsWith("found \"inf\""));
  CHECK_THAT(error("[fx,0,160,0,300,120,0,0,1]"), EndsWith("found \"fx\""));
  CHECK_THAT(error("[{a: 1},0,160,0,300,120,0,0,1]"), EndsWith("K: expected a number"));
  CHECK_THAT(error("$base64$YWJj"),
             Contains("K: expected numbers: a list, or a matrix with rows, cols and data"));
  CHECK_THAT(error("{rows: 3, cols: 3}"), EndsWith("missing key data"));
  CHECK_THAT(error("{rows: 3, cols: 3, data: 5}"), EndsWith("data: expected a list of numbers"));
  CHECK_THAT(error("{rows: 3, cols: 4, data: [300,0,160,0,300,120,0,0,1]}"),
             EndsWith("data: expected rows x cols = 3 x 4 numbers, found 9"));
}

TEST_CASE("Distortions that are none") {
  for (const char *list : {"[0, 0, 0]", "[0, 0, 0, 0, 0, 0]"})
    CHECK_THAT(error_of(brief(list)), Contains("D: expected 4, 5, 8, 12 or 14 numbers, found"));
  CHECK_THAT(error_of(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]")),
             EndsWith("D: expected at most 14 numbers"));
  CHECK_THAT(error_of(brief("[1.1e6, 0, 0, 0]")),
             EndsWith("D: expected coefficients from -1000000 to 1000000, found 1100000"));
}

TEST_CASE("Sizes that are none") {
  CHECK_THAT(error_of(ros_with("image_width: 320", "image_width: 0")),
             EndsWith("camera.yml:1:1: image_width: expected an integer from 1 to 8192, found 0"));
  CHECK_THAT(error_of(ros_with("image_height: 240", "image_height: 8193")),
             EndsWith("camera.yml:2:1: image_height: expected an integer from 1 to 8192, found 8193"));
  CHECK_THAT(error_of(ros_with("image_width: 320", "image_width: 320.5")), EndsWith("found 320.5"));
  CHECK_THAT(error_of(ros_with("image_width: 320", "image_width: wide")),
             EndsWith("image_width: expected a finite number, found \"wide\""));
  CHECK_THAT(error_of("image_size: [1, 2, 3]"), EndsWith("image_size: expected at most 2 numbers"));
  CHECK_THAT(error_of("image_size: [1]"), EndsWith("image_size: expected width and height, found 1 numbers"));
}

TEST_CASE("Missing and doubled keys") {
  CHECK_THAT(
      error_of("a: 1"),
      EndsWith("camera.yml: missing key image_size (or imageSize, resolution, image_width, image_Width, "
               "img_width, width)"));
  CHECK_THAT(error_of(ros_with("image_height", "other")),
             EndsWith("camera.yml: missing key image_height (or image_Height, img_height, height)"));
  CHECK_THAT(
      error_of(ros_with("camera_matrix", "other")),
      EndsWith("missing key camera_matrix (or cameraMatrix, Camera_Matrix, intrinsic_matrix, K, k, M)"));
  CHECK_THAT(error_of(ros_with("distortion_coefficients", "other")),
             Contains("missing key distortion_coefficients (or "));
  CHECK_THAT(error_of(brief("[0, 0, 0, 0]") + "camera_matrix: [1]"),
             EndsWith("camera.yml:4:1: camera_matrix: expected once, found K in line 2 too"));
  CHECK_THAT(error_of(brief("[0, 0, 0, 0]") + "D: [0]"), EndsWith("D: expected once, found D in line 3 too"));
  CHECK_THAT(error_of(brief("[0, 0, 0, 0]") + "d: [0]"), EndsWith("d: expected once, found D in line 3 too"));
}

TEST_CASE("What is no calibration at all") {
  CHECK_THAT(error_of(""),
             EndsWith("camera.yml: expected a calibration, keys with values, in YAML, JSON or XML"));
  CHECK_THAT(error_of("[1, 2]"), EndsWith("expected a calibration, keys with values, in YAML, JSON or XML"));
  CHECK_THAT(error_of("\xef\xbb\xbf\n<?xml version=\"1.0\"?>\n<opencv_storage>"),
             Contains("camera.yml:3:") && Contains(": not valid XML: "));
  CHECK_THAT(error_of("<html><body/></html>"),
             EndsWith("camera.yml: expected OpenCV's <opencv_storage> in XML"));
  CHECK_THAT(error_of("image_width: 3\nK: [1, 2\n"),
             Contains("camera.yml:") && Contains("not valid YAML or JSON: "));
  CHECK_THAT(error_of("a: *nobody"), Contains("camera.yml:1:4: not valid YAML or JSON: "));
  CHECK_THAT(error_of("\"\\\xff\""), EndsWith("not valid YAML or JSON: unknown escape character: ?"));
  error_of(std::string(1000, '\0'));
}

TEST_CASE("Calibrations that are no regular files, or too large") {
  const TemporaryFolder folder;
  const auto error = [](const std::filesystem::path &file) {
    return input_error_of([&] { read_calibration(file); });
  };
  CHECK_THAT(error(folder.path() / "absent.yml"), EndsWith("absent.yml: no such file"));
  CHECK_THAT(error(folder.path()), EndsWith(": is a directory, expected a file"));
  const auto pipe = folder.path() / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(error(pipe), EndsWith("pipe: is no regular file"));
  CHECK_THAT(error(folder.write("huge.yml", std::string(5u << 20, '#'))),
             Contains("expected at most 4194304"));
}

TEST_CASE("Nests, alias bombs and endless lists come to an end") {
  for (const std::string &nest :
       {std::string("["), std::string("{a: "), std::string("- "), std::string("? ")}) {
    std::string text;
    for (int i = 0; i < 100'000; ++i)
      text += nest;
    CHECK_THAT(error_of(text), Contains("not valid YAML or JSON: nested too deep"));
  }
  CHECK_THAT(error_of("a: [" + std::string(300'000, ',') + "]"), Contains("not valid YAML or JSON: "));
  std::string list = "a: [";
  for (int i = 0; i < 300'000; ++i)
    list += "0,";
  CHECK_THAT(error_of(list + "]"), Contains("not valid YAML or JSON: more than 250000 values"));

  // Nine to the power of 16 numbers.
  std::string bomb = "of_a: &a [1,1,1,1,1,1,1,1,1]\n";
  for (char name = 'b'; name <= 'p'; ++name) {
    const std::string inner = std::string("*") + static_cast<char>(name - 1);
    bomb += fmt::format("of_{0}: &{0} [{1},{1},{1},{1},{1},{1},{1},{1},{1}]\n", name, inner);
  }
  CHECK_THAT(error_of(bomb + "image_size: [1, 1]\nK: *p\n"), EndsWith("K: expected a number"));
  CHECK_THAT(error_of(bomb + "image_size: [1, 1]\nK: *b\n"), EndsWith("K: expected at most 9 numbers"));
  CHECK_THAT(error_of("image_size: &s [*s, *s]"), Contains("image_size: expected a number"));
}

TEST_CASE("What OpenCV writes as XML") {
  const std::string xml = R"(<?xml version="1.0"?>
<opencv_storage>
<image_width>640</image_width>
<image_height>480</image_height>
<camera_matrix type_id="opencv-matrix">
  <rows>3</rows>
  <cols>3</cols>
  <dt>d</dt>
  <data>
    650. 0. 319.5 0. 660. 239.5 0. 0. 1.</data></camera_matrix>
<distortion_coefficients type_id="opencv-matrix">
  <rows>5</rows>
  <cols>1</cols>
  <dt>d</dt>
  <data>
    -4.1e-01 0.5 1e-3 -2e-3 -0.57</data></distortion_coefficients>
</opencv_storage>
)";
  const Calibration c = read(xml), same = read(opencv_yaml);
  CHECK(c.resolution == same.resolution);
  CHECK(c.fx == same.fx);
  CHECK(c.cy == same.cy);
  CHECK(std::get<BrownConrady>(c.distortion).k3 == std::get<BrownConrady>(same.distortion).k3);
  CHECK_THAT(error_of(with(xml, "650.", "wide")),
             EndsWith("camera.yml: camera_matrix: expected a finite number, found \"wide\""));
  std::string nest = "<opencv_storage>";
  for (int i = 0; i < 10'000; ++i)
    nest += "<a>";
  error_of(nest);
  for (int i = 0; i < 10'000; ++i)
    nest += "</a>";
  CHECK_THAT(error_of(nest + "</opencv_storage>"), Contains("expected elements nested at most 32 deep"));
}

TEST_CASE("ROS's binning and region of interest") {
  const std::string roi = "  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n";
  const std::string part =
      with(ros2_message, roi, "  x_offset: 40\n  y_offset: 20\n  height: 100\n  width: 201\n");
  Calibration c = read(part);
  CHECK(c.resolution == glm::uvec2(201, 100));
  CHECK(c.fx == 300.0);
  CHECK(c.cx == 160.5 - 40.0);
  CHECK(c.cy == 120.5 - 20.0);
  c = read(with(with(part, "binning_x: 0", "binning_x: 2"), "binning_y: 0", "binning_y: 4"));
  CHECK(c.resolution == glm::uvec2(100, 25));
  CHECK(c.binning == glm::uvec2(2, 4));
  CHECK(c.fx == 150.0);
  CHECK(c.fy == 301.0 / 4.0);
  // The centre of the first binned pixel lies between the centres of full pixels 0 and 1, and of 0 to 3.
  CHECK(c.cx == (160.5 - 40.0 - 0.5) / 2.0);
  CHECK(c.cy == (120.5 - 20.0 - 1.5) / 4.0);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == -0.3);

  CHECK_THAT(
      error_of(with(part, "width: 201", "width: 300")),
      EndsWith("roi: expected a region within the image of 320 x 240 pixels, found 300 x 100 from column "
               "40, row 20 on"));
  CHECK_THAT(error_of(with(part, "width: 201", "width: 0")),
             Contains("roi: expected a region within the image"));
  CHECK_THAT(error_of(with(part, "binning_x: 0", "binning_x: 1.5")),
             EndsWith("binning_x: expected a whole number from 0 to 64, found 1.5"));
  CHECK_THAT(error_of(with(with(part, "width: 201", "width: 3"), "binning_x: 0", "binning_x: 4")),
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
  const Calibration first = read(kalibr), second = read(kalibr, "cam1");
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
  CHECK_THAT(error_of(kalibr, "cam2"), EndsWith("--camera: expected cam0 or cam1, found \"cam2\""));
  CHECK_THAT(error_of(with(kalibr, "camera_model: pinhole", "camera_model: omni")),
             Contains("camera.yml:2:3: camera_model: expected pinhole, the only camera model of Kalibr's") &&
                 EndsWith("found \"omni\""));
  CHECK_THAT(error_of(with(kalibr, "radtan", "fov")),
             EndsWith("expected radtan, equidistant or none, found \"fov\""));
  CHECK_THAT(
      error_of(with(kalibr, "[0.0, 0.0, 1.0, 0.03]", "[0.0, 0.0, 2.0, 0.03]"), "cam1"),
      EndsWith(
          "T_cn_cnm1: expected a rotation and a translation, found a matrix that scales, shears or mirrors"));
  CHECK_THAT(error_of(ros_yaml, "cam1"), EndsWith("--camera: the file has one camera, found \"cam1\""));
}

TEST_CASE("OpenCV's pairs of cameras") {
  const std::string pair = "image_size: [320, 240]\n"
                           "M1: [300,0,160,0,301,120,0,0,1]\nD1: [0.1,0,0,0,0]\n"
                           "M2: [310,0,161,0,311,121,0,0,1]\nD2: [0.2,0,0,0,0]\n"
                           "R: [1,0,0,0,1,0,0,0,1]\nT: [-0.12, 0.01, 0.02]\n";
  CHECK(read(pair).fy == 301.0);
  const Calibration second = read(pair, "2");
  CHECK(second.fx == 310.0);
  CHECK(std::get<BrownConrady>(second.distortion).k1 == 0.2);
  CHECK(second.first_from_camera.translation_m == glm::dvec3(0.12, -0.01, -0.02));
}

TEST_CASE("Intrinsics as Open3D, RealSense and others write them") {
  Calibration c =
      read(R"({"width": 640, "height": 480, "intrinsic_matrix": [600, 0, 0, 0, 601, 0, 320, 240, 1]})");
  CHECK(c.fy == 601.0);
  CHECK(c.cx == 320.0);
  CHECK(c.cy == 240.0);
  c = read(R"({"width": 640, "height": 480, "fx": 600, "fy": 601, "ppx": 320, "ppy": 240,
               "model": "Brown Conrady", "coeffs": [0.1, 0.2, 0.3, 0.4, 0.5]})");
  CHECK(c.cy == 240.0);
  CHECK(std::get<BrownConrady>(c.distortion).k3 == 0.5);
  c = read("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\nk1: 0.1\np2: 0.4\n");
  CHECK(std::get<BrownConrady>(c.distortion).p2 == 0.4);
  CHECK(std::holds_alternative<std::monostate>(
      read("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\n").distortion));
  CHECK_THAT(error_of("width: 640\nheight: 480\nfx: 600\nfy: 601\ncx: 320\ncy: 240\nk5: 0.1\n"),
             EndsWith("camera.yml:7:1: k5: k5: expected 0: pmdsim has no rational terms, found 0.1"));
}
