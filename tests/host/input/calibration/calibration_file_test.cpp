// Calibrations as OpenCV and ROS write them, and what is wrong with them.

#include "tests/host/input/calibration/calibration_texts.h"

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

std::string ros_with(const std::string &from, const std::string &to) { return replaced(ros_yaml, from, to); }

// A calibration in few lines.
std::string brief(const std::string &distortion, const std::string &matrix = "[300,0,160,0,300,120,0,0,1]") {
  return "image_size: [320, 240]\nK: " + matrix + "\nD: " + distortion + "\n";
}

} // namespace

TEST_CASE("What OpenCV's calibration writes as YAML") {
  for (const std::string &text : {std::string(opencv_yaml), replaced(opencv_yaml, "---\n", ""),
                                  replaced(opencv_yaml, "%YAML:1.0\n---\n", "")}) {
    const Calibration c = calibration_of(text);
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
  const Calibration c = calibration_of(R"({
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
  const Calibration c = calibration_of(ros_yaml);
  CHECK(c.name == "narrow_stereo/left");
  CHECK(c.resolution == glm::uvec2(320, 240));
  CHECK(c.fx == 300.0);
  CHECK(c.cy == 120.5);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == -0.3);
}

TEST_CASE("What ROS 2 prints of a message") {
  for (const std::string &text : {std::string(ros2_message), replaced(ros2_message, "---\n", "")}) {
    const Calibration c = calibration_of(text);
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
  const std::string none = replaced(ros2_message, numbers, "d: []\n");
  const std::string zeros = replaced(ros2_message, numbers, "d:\n- 0.0\n- 0.0\n- 0.0\n- 0.0\n- 0.0\n");
  for (const std::string &text : {none, zeros}) {
    CHECK(std::holds_alternative<std::monostate>(calibration_of(text).distortion));
    const Calibration c =
        calibration_of(replaced(text, "distortion_model: plumb_bob", "distortion_model: ''"));
    CHECK(std::holds_alternative<std::monostate>(c.distortion));
    CHECK(c.fy == 301.0);
  }
  CHECK_THAT(calibration_error_of(replaced(ros2_message, "plumb_bob", "''")),
             EndsWith("camera.yml:9:1: d: expected no coefficients but 0 beside an empty distortion_model"));
}

TEST_CASE("Matrices may be lists of rows, and keys short") {
  const Calibration c =
      calibration_of(brief("[[0.1, 0, 0, 0, 0]]", "[[300, 0, 160], [0, 310, 120], [0, 0, 1]]"));
  CHECK(c.resolution == glm::uvec2(320, 240));
  CHECK(c.fy == 310.0);
  CHECK(c.cy == 120.0);
  CHECK(std::get<BrownConrady>(c.distortion).k1 == 0.1);
}

TEST_CASE("Zeros are no distortion") {
  CHECK(std::holds_alternative<std::monostate>(calibration_of(brief("[0, 0, 0, 0]")).distortion));
  CHECK(std::holds_alternative<std::monostate>(
      calibration_of(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]")).distortion));
}

TEST_CASE("An empty list is no distortion") {
  for (const char *list : {"[]", "{rows: 0, cols: 0, data: []}", "{data: []}"}) {
    const std::string text = brief(list);
    CHECK(std::holds_alternative<std::monostate>(calibration_of(text).distortion));
    CHECK(std::holds_alternative<std::monostate>(calibration_of(text + "distortion_model: \"\"").distortion));
    CHECK_THAT(calibration_error_of(text + "distortion_model: equidistant"),
               EndsWith("D: expected the fisheye's k1 to k4, found 0 numbers"));
  }
}

TEST_CASE("A fisheye is one by OpenCV's flag or by the model's name") {
  const std::string four = brief("[0.1, 0.2, 0.3, 0.4]");
  CHECK(std::holds_alternative<BrownConrady>(calibration_of(four).distortion));
  CHECK(
      std::holds_alternative<BrownConrady>(calibration_of(four + "distortion_model: plumb_bob").distortion));
  CHECK(std::holds_alternative<BrownConrady>(calibration_of(four + "fisheye_model: 0").distortion));
  for (const char *line : {"fisheye_model: 1", "distortion_model: fisheye", "distortion_model: equidistant",
                           "distortion_model: \"kannala_brandt\""}) {
    const auto d = std::get<Fisheye>(calibration_of(four + line).distortion);
    CHECK(d.k1 == 0.1);
    CHECK(d.k4 == 0.4);
  }
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0, 0]") + "fisheye_model: 1"),
             EndsWith("D: expected the fisheye's k1 to k4, found 5 numbers"));
  CHECK_THAT(calibration_error_of(four + "fisheye_model: 2"),
             EndsWith("fisheye_model: expected 0 or 1, found 2"));
  CHECK_THAT(calibration_error_of(four + "distortion_model: omni"),
             Contains("camera.yml:4:1: distortion_model: expected plumb_bob,") && EndsWith("found \"omni\""));
}

TEST_CASE("OpenCV's tilt is read, its rational and thin prism terms are refused by name") {
  const Calibration c = calibration_of(brief("[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.02, -0.03]"));
  CHECK(c.tau_x_rad == 0.02);
  CHECK(c.tau_y_rad == -0.03);
  CHECK_THAT(calibration_error_of(brief("[0.1, 0, 0, 0, 0, 0, 0.5, 0]")),
             EndsWith("camera.yml:3:1: D: k5: expected 0: pmdsim has no rational terms, found 0.5"));
  CHECK_THAT(calibration_error_of(brief("[0.1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2]")),
             EndsWith("D: s4: expected 0: pmdsim has no thin prism terms, found 2"));
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1.6]")),
             EndsWith("D: tauY: expected a tilt within 89 degrees, found 1.6 rad"));
}

TEST_CASE("Camera matrices that are none") {
  const auto error = [](const std::string &matrix) {
    return calibration_error_of(brief("[0, 0, 0, 0]", matrix));
  };
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
    CHECK_THAT(calibration_error_of(brief(list)), Contains("D: expected 4, 5, 8, 12 or 14 numbers, found"));
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]")),
             EndsWith("D: expected at most 14 numbers"));
  CHECK_THAT(calibration_error_of(brief("[1.1e6, 0, 0, 0]")),
             EndsWith("D: expected coefficients from -1000000 to 1000000, found 1100000"));
}

TEST_CASE("Sizes that are none") {
  CHECK_THAT(calibration_error_of(ros_with("image_width: 320", "image_width: 0")),
             EndsWith("camera.yml:1:1: image_width: expected an integer from 1 to 8192, found 0"));
  CHECK_THAT(calibration_error_of(ros_with("image_height: 240", "image_height: 8193")),
             EndsWith("camera.yml:2:1: image_height: expected an integer from 1 to 8192, found 8193"));
  CHECK_THAT(calibration_error_of(ros_with("image_width: 320", "image_width: 320.5")),
             EndsWith("found 320.5"));
  CHECK_THAT(calibration_error_of(ros_with("image_width: 320", "image_width: wide")),
             EndsWith("image_width: expected a finite number, found \"wide\""));
  CHECK_THAT(calibration_error_of("image_size: [1, 2, 3]"),
             EndsWith("image_size: expected at most 2 numbers"));
  CHECK_THAT(calibration_error_of("image_size: [1]"),
             EndsWith("image_size: expected width and height, found 1 numbers"));
}

TEST_CASE("Missing and doubled keys") {
  CHECK_THAT(
      calibration_error_of("a: 1"),
      EndsWith("camera.yml: missing key image_size (or imageSize, resolution, image_width, image_Width, "
               "img_width, width)"));
  CHECK_THAT(calibration_error_of(ros_with("image_height", "other")),
             EndsWith("camera.yml: missing key image_height (or image_Height, img_height, height)"));
  CHECK_THAT(
      calibration_error_of(ros_with("camera_matrix", "other")),
      EndsWith("missing key camera_matrix (or cameraMatrix, Camera_Matrix, intrinsic_matrix, K, k, M)"));
  CHECK_THAT(calibration_error_of(ros_with("distortion_coefficients", "other")),
             Contains("missing key distortion_coefficients (or "));
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0]") + "camera_matrix: [1]"),
             EndsWith("camera.yml:4:1: camera_matrix: expected once, found K in line 2 too"));
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0]") + "D: [0]"),
             EndsWith("D: expected once, found D in line 3 too"));
  CHECK_THAT(calibration_error_of(brief("[0, 0, 0, 0]") + "d: [0]"),
             EndsWith("d: expected once, found D in line 3 too"));
}

TEST_CASE("What is no calibration at all") {
  CHECK_THAT(calibration_error_of(""),
             EndsWith("camera.yml: expected a calibration, keys with values, in YAML, JSON or XML"));
  CHECK_THAT(calibration_error_of("[1, 2]"),
             EndsWith("expected a calibration, keys with values, in YAML, JSON or XML"));
  CHECK_THAT(calibration_error_of("\xef\xbb\xbf\n<?xml version=\"1.0\"?>\n<opencv_storage>"),
             Contains("camera.yml:3:") && Contains(": not valid XML: "));
  CHECK_THAT(calibration_error_of("<html><body/></html>"),
             EndsWith("camera.yml: expected OpenCV's <opencv_storage> in XML"));
  CHECK_THAT(calibration_error_of("image_width: 3\nK: [1, 2\n"),
             Contains("camera.yml:") && Contains("not valid YAML or JSON: "));
  CHECK_THAT(calibration_error_of("a: *nobody"), Contains("camera.yml:1:4: not valid YAML or JSON: "));
  CHECK_THAT(calibration_error_of("\"\\\xff\""),
             EndsWith("not valid YAML or JSON: unknown escape character: ?"));
  calibration_error_of(std::string(1000, '\0'));
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
    CHECK_THAT(calibration_error_of(text), Contains("not valid YAML or JSON: nested too deep"));
  }
  CHECK_THAT(calibration_error_of("a: [" + std::string(300'000, ',') + "]"),
             Contains("not valid YAML or JSON: "));
  std::string list = "a: [";
  for (int i = 0; i < 300'000; ++i)
    list += "0,";
  CHECK_THAT(calibration_error_of(list + "]"), Contains("not valid YAML or JSON: more than 250000 values"));

  // Nine to the power of 16 numbers.
  std::string bomb = "of_a: &a [1,1,1,1,1,1,1,1,1]\n";
  for (char name = 'b'; name <= 'p'; ++name) {
    const std::string inner = std::string("*") + static_cast<char>(name - 1);
    bomb += fmt::format("of_{0}: &{0} [{1},{1},{1},{1},{1},{1},{1},{1},{1}]\n", name, inner);
  }
  CHECK_THAT(calibration_error_of(bomb + "image_size: [1, 1]\nK: *p\n"), EndsWith("K: expected a number"));
  CHECK_THAT(calibration_error_of(bomb + "image_size: [1, 1]\nK: *b\n"),
             EndsWith("K: expected at most 9 numbers"));
  CHECK_THAT(calibration_error_of("image_size: &s [*s, *s]"), Contains("image_size: expected a number"));
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
  const Calibration c = calibration_of(xml), same = calibration_of(opencv_yaml);
  CHECK(c.resolution == same.resolution);
  CHECK(c.fx == same.fx);
  CHECK(c.cy == same.cy);
  CHECK(std::get<BrownConrady>(c.distortion).k3 == std::get<BrownConrady>(same.distortion).k3);
  CHECK_THAT(calibration_error_of(replaced(xml, "650.", "wide")),
             EndsWith("camera.yml: camera_matrix: expected a finite number, found \"wide\""));
  std::string nest = "<opencv_storage>";
  for (int i = 0; i < 10'000; ++i)
    nest += "<a>";
  calibration_error_of(nest);
  for (int i = 0; i < 10'000; ++i)
    nest += "</a>";
  CHECK_THAT(calibration_error_of(nest + "</opencv_storage>"),
             Contains("expected elements nested at most 32 deep"));
}

TEST_CASE("XML is a list or a map, and no more values than YAML has") {
  const auto error_of = [](const std::string &content) {
    return calibration_error_of("<opencv_storage><image_width>" + content +
                                "</image_width></opencv_storage>");
  };
  const std::string both = "expected elements of a list, <_>, or others in <image_width>, found both";
  CHECK_THAT(error_of("<a>1</a><_>2</_>"), EndsWith(both));
  CHECK_THAT(error_of("<_>2</_><a>1</a>"), EndsWith(both));
  std::string many;
  for (int i = 0; i < 250'001; ++i)
    many += "1 ";
  CHECK_THAT(error_of(many), EndsWith("expected at most 250000 values"));
}
