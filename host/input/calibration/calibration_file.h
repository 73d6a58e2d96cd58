#pragma once
// A camera's calibration as tools write it: OpenCV's FileStorage (YAML or JSON) and ROS's camera_info (YAML).

#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"

#include <filesystem>
#include <string>

namespace pmdsim {

// A key of the file, for errors.
struct CalibrationKey {
  std::string name;
  TextPlace place;
};

Error input_error(const CalibrationKey &key, const std::string &message);

struct Calibration {
  std::string name;                        // ROS's camera_name; empty where there is none
  glm::uvec2 resolution;                   // columns, rows, 1 to 8192
  double fx = 0.0, fy = 0.0;               // pixels, above 0
  double cx = 0.0, cy = 0.0;               // pixels; the CENTRE of pixel (0, 0) lies at (0, 0)
  Distortion distortion;                   // no coefficient beyond the setup's range
  double tau_x_rad = 0.0, tau_y_rad = 0.0; // tilt of the chip in OpenCV's model (tauX, tauY)
  CalibrationKey camera_matrix_at, distortion_at;
};

// Throws Error (input): "FILE:LINE:COLUMN: KEY: ...", or "FILE: missing key ...".
Calibration read_calibration(const std::filesystem::path &file);

} // namespace pmdsim
