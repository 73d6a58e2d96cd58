#pragma once
// The part of the chip that a camera reads out, as ROS's camera_info tells it.

#include "host/input/calibration/calibration_file.h"
#include "host/input/calibration/calibration_yaml.h"

namespace pmdsim {

// Applies binning_x, binning_y and roi to a calibration of the whole chip at full resolution. A region of
// interest is in full pixels, and binned pixels fill it from its upper left corner on. The centre of a binned
// pixel is the centre of the pixels in it. (ROS's image_geometry leaves that half pixel out.) Throws Error
// (input): a region beyond the image, or one without a whole pixel.
void apply_readout(const CalibrationMap &map, Calibration &calibration);

} // namespace pmdsim
