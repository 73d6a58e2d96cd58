#include "host/commands/commands.h"
#include "host/input/calibration/calibration_sensor.h"
#include "host/output/files/manifest.h"
#include "host/report/report.h"

#include <fmt/format.h>

namespace pmdsim {

void run_import_calibration(const Options &options) {
  const double pixel_pitch_m = options.pixel_pitch_m.value_or(default_pixel_pitch_m);
  Sensor sensor = sensor_of(read_calibration(options.calibration), pixel_pitch_m);
  if (!options.sensor_name.empty())
    sensor.name = options.sensor_name;
  const std::string pitch =
      options.pixel_pitch_m
          ? ""
          : fmt::format("the pixel pitch is assumed to be {} m (--pixel-pitch-m changes it), ",
                        pixel_pitch_m);
  fmt::print(stderr, "pmdsim: note: {}modulation_hz is assumed to be {:g}; no calibration file has it\n",
             pitch, sensor.modulation_hz.front());
  print(json_text(sensor_block(sensor)));
}

} // namespace pmdsim
