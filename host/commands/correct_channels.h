#pragma once
// The channels of a corrected image, as files have them.

#include "engine/correction/correction.h"
#include "host/output/files/channel.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// corrected_channel_rows of engine/correction/corrected_channels.h, and their values.
struct CorrectedChannels {
  CorrectedChannels(const CorrectedImage &corrected, const Sensor &sensor);
  CorrectedChannels(const CorrectedChannels &) = delete; // `set` looks at the values
  CorrectedChannels &operator=(const CorrectedChannels &) = delete;

  std::vector<float> range_m, x_m, y_m, z_m, correction_mm, normal_error_mm;
  std::vector<std::uint32_t> status;
  std::vector<glm::vec3> normals; // world frame
  ChannelSet set;
};

} // namespace pmdsim
