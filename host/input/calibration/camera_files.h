#pragma once
// The forms of calibration files, each told by the keys that it has. All throw Error (input).

#include "host/input/calibration/calibration_file.h"
#include "host/input/calibration/calibration_yaml.h"

#include <string>

namespace pmdsim {

// One camera: OpenCV's and ROS's names, or Open3D's, RealSense's and plain ones.
Calibration single_camera(const CalibrationMap &map);

// Kalibr's camchain: cam0, cam1, ..., each with intrinsics and where it stands to the one before it.
bool is_camchain(const CalibrationMap &map);
Calibration camera_of_camchain(const CalibrationMap &map, const std::string &camera);

// OpenCV's pair of cameras: M1, D1, M2, D2, and R, T from the first camera's frame to the second one's.
bool is_pair(const CalibrationMap &map);
Calibration camera_of_pair(const CalibrationMap &map, const std::string &camera);

} // namespace pmdsim
