#pragma once
// A calibrated camera as a sensor of a setup.

#include "engine/model/sensor.h"
#include "host/input/calibration/calibration_file.h"

#include <nlohmann/json.hpp>
#include <string_view>

namespace pmdsim {

inline constexpr double default_pixel_pitch_m = 10e-6; // no calibration file has it

// Whether a setup takes `name` as a sensor's.
bool is_sensor_name(std::string_view name);

// A sensor that images as OpenCV's projectPoints does with the calibration's numbers, whatever the pitch of a
// physical pixel along the columns; that sets the scale only. Modulation and all else are defaults. Where the
// distortion folds over inside the image, pixels beyond are dark. Throws Error (input): a lens or chip beyond
// the setup's ranges.
Sensor sensor_of(const Calibration &calibration, double pixel_pitch_m);

// An element of a setup's /sensors: what describes lens and chip, and the modulation, which has no default.
nlohmann::ordered_json sensor_block(const Sensor &sensor);

// A camera's pose where the first camera of the file stands at the world's origin, as a sensor without a pose
// does: a chain whose first link is the first camera's pose, to be replaced by where it really is.
nlohmann::ordered_json pose_block(const Pose &first_from_camera);

} // namespace pmdsim
