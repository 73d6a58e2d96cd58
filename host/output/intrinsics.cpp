#include "host/output/intrinsics.h"

namespace pmdsim {

Intrinsics intrinsics_of(const Sensor &sensor) {
  return {sensor.image_distance_m() / sensor.pixel_pitch_m.x,
          sensor.image_distance_m() / sensor.pixel_pitch_m.y, (sensor.resolution.x - 1.0) / 2.0,
          (sensor.resolution.y - 1.0) / 2.0};
}

} // namespace pmdsim
