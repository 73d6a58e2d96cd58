#pragma once
// Calibrations from texts.

#include "host/input/calibration/calibration_file.h"
#include "tests/host/input/file/input_error_of.h"
#include "tests/support/temporary_folder.h"

#include <catch2/catch.hpp>
#include <string>

namespace pmdsim::test {

// As ROS's camera_calibration writes it.
inline constexpr const char *ros_yaml = R"(image_width: 320
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
inline constexpr const char *ros2_message = R"(header:
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

inline Calibration calibration_of(const std::string &text, const std::string &camera = {}) {
  const TemporaryFolder folder;
  return read_calibration(folder.write("camera.yml", text), camera);
}

inline std::string calibration_error_of(const std::string &text, const std::string &camera = {}) {
  return input_error_of([&] { calibration_of(text, camera); });
}

inline std::string replaced(std::string text, const std::string &from, const std::string &to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

} // namespace pmdsim::test
