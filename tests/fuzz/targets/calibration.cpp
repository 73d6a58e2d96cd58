// Calibrations of every kind: YAML, JSON and XML. The first byte says which camera of several is asked for.

#include "tests/fuzz/target.h"

#include "host/input/calibration/calibration_sensor.h"

#include <array>

using namespace pmdsim;

FUZZ_TARGET(calibration) {
  constexpr std::array cameras{"", "1", "2", "cam1", "left"};
  if (size == 0)
    return 0;
  const std::filesystem::path file = fuzz::write_file("calibration.yaml", fuzz::text_of(data + 1, size - 1));
  fuzz::accepts([&] {
    const Calibration calibration = read_calibration(file, cameras[data[0] % cameras.size()]);
    static_cast<void>(sensor_block(sensor_of(calibration, default_pixel_pitch_m)).dump());
    static_cast<void>(pose_block(calibration.first_from_camera).dump());
  });
  return 0;
}
