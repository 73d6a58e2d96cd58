#include "host/output/channel.h"

namespace pmdsim {

ChannelSet channels_of(const Measurement &measurement) {
  const auto floats = [](const std::vector<float> &values) { return std::span<const float>(values); };
  const auto ids = [](const std::vector<std::uint32_t> &values) {
    return std::span<const std::uint32_t>(values);
  };
  return {measurement.resolution,
          {{"amplitude", "W/(m² sr)", floats(measurement.returns[0].amplitude)},
           {"phase_rad", "rad", floats(measurement.returns[0].phase_rad)},
           {"distance_m", "m", floats(measurement.returns[0].distance_m)},
           {"range_m", "m", floats(measurement.range_m)},
           {"z_m", "m", floats(measurement.z_m)},
           {"coverage", "", floats(measurement.coverage)},
           {"triangle_id", "", ids(measurement.triangle_id)},
           {"object_id", "", ids(measurement.object_id)}}};
}

} // namespace pmdsim
