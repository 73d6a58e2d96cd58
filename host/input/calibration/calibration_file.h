#pragma once
// A camera's calibration as tools write it: OpenCV's FileStorage (YAML, JSON or XML), of one camera or of
// two, ROS's camera_info, Kalibr's camchain, Open3D's and RealSense's intrinsics, and plain fx, fy, cx, cy.

#include "engine/model/pose.h"
#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pmdsim {

// A key of the file, for errors.
struct CalibrationKey {
  std::string name;
  TextPlace place;
};

Error input_error(const CalibrationKey &key, const std::string &message);

// Resolution, focal lengths and principal point are those of the image that the camera gives, behind ROS's
// binning and region of interest.
struct Calibration {
  std::string name;                        // ROS's camera_name, Kalibr's cam0; empty where there is none
  glm::uvec2 resolution{0, 0};             // columns, rows, 1 to 8192
  glm::uvec2 binning{1, 1};                // physical pixels in one, columns and rows
  double fx = 0.0, fy = 0.0;               // pixels, above 0
  double cx = 0.0, cy = 0.0;               // pixels; the CENTRE of pixel (0, 0) lies at (0, 0)
  Distortion distortion;                   // no coefficient beyond the setup's range
  double tau_x_rad = 0.0, tau_y_rad = 0.0; // tilt of the chip in OpenCV's model (tauX, tauY)
  CalibrationKey camera_matrix_at, distortion_at;
  // Of a file with several cameras: all their names, and where this one stands in the first one's frame.
  std::vector<std::string> cameras{};
  Pose first_from_camera{};
};

// `camera` names one of a file's cameras, "cam1" as Kalibr does, "1" or "2" of OpenCV's pairs; empty: the
// first. Throws Error (input): "FILE:LINE:COLUMN: KEY: ...", or "FILE: missing key ...".
Calibration read_calibration(const std::filesystem::path &file, const std::string &camera = {});

} // namespace pmdsim
