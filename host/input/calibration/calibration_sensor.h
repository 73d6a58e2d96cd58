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

// A sensor that images as OpenCV's projectPoints does with the calibration's numbers, whatever the pitch
// along the columns; that sets the scale only. Modulation and all else are defaults. Throws Error (input): a
// distortion that folds over inside the image, a lens or chip beyond the setup's ranges.
Sensor sensor_of(const Calibration &calibration, double pixel_pitch_m);

// An element of a setup's /sensors: what describes lens and chip, and the modulation, which has no default.
nlohmann::ordered_json sensor_block(const Sensor &sensor);

} // namespace pmdsim
