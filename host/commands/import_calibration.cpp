#include "host/commands/commands.h"
#include "host/input/calibration/calibration_sensor.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pmdsim {

void run_import_calibration(const Options &options) {
  const double pixel_pitch_m = options.pixel_pitch_m.value_or(default_pixel_pitch_m);
  const Calibration calibration = read_calibration(options.calibration, options.calibrated_camera);
  Sensor sensor = sensor_of(calibration, pixel_pitch_m);
  if (!options.sensor_name.empty())
    sensor.name = options.sensor_name;
  const std::string pitch =
      options.pixel_pitch_m
          ? ""
          : fmt::format("the pixel pitch is assumed to be {} m (--pixel-pitch-m changes it), ",
                        pixel_pitch_m);
  tell(fmt::format("note: {}modulation_hz is assumed to be {:g}; no calibration file has it", pitch,
                   sensor.modulation_hz.front()));
  if (calibration.cameras.size() > 1 && options.calibrated_camera.empty())
    tell(fmt::format("note: the file has the cameras {}, this is {} (--camera takes another)",
                     fmt::join(calibration.cameras, ", "), calibration.cameras.front()));
  if (sensor.dark_beyond_fold)
    tell("note: the distortion folds over inside the image, whose pixels beyond see nothing "
         "(\"beyond\": \"dark\")");
  nlohmann::ordered_json block = sensor_block(sensor);
  if (calibration.first_from_camera != Pose())
    block["pose"] = pose_block(calibration.first_from_camera);
  print(json_text(block));
}

} // namespace pmdsim
