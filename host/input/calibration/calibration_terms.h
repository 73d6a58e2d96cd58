#pragma once
// Camera matrices and coefficients of distortion, as the names and the order of OpenCV have them.

#include "host/input/calibration/calibration_file.h"
#include "host/input/calibration/calibration_yaml.h"

#include <string>
#include <vector>

namespace pmdsim {

enum class DistortionModel { brown, fisheye, nameless };

// The form of 3 x 3 numbers: row by row, or column by column as Open3D writes them.
enum class MatrixOrder { rows, columns };

// All of them set parts of `calibration` and throw Error (input) at the entry.

// [fx, 0, cx, 0, fy, cy, 0, 0, 1].
void read_camera_matrix(const CalibrationEntry &entry, Calibration &calibration,
                        MatrixOrder order = MatrixOrder::rows);
// fx, fy, cx, cy, one after the other.
void set_camera_matrix(const CalibrationKey &key, const std::vector<double> &fx_fy_cx_cy,
                       Calibration &calibration);
// Brown-Conrady's 4, 5, 8, 12 or 14 coefficients in OpenCV's order, a fisheye's 4, or none.
void set_distortion(const CalibrationKey &key, const std::vector<double> &coefficients, DistortionModel model,
                    Calibration &calibration);
void read_distortion(const CalibrationEntry &entry, DistortionModel model, Calibration &calibration);

// A number of pixels along an image, 1 to 8192.
std::uint32_t pixels_of(const CalibrationKey &key, double number);
// Two numbers of an entry.
glm::uvec2 size_of(const CalibrationEntry &entry);

} // namespace pmdsim
