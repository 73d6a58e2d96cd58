#include "host/commands/correct_channels.h"

#include "engine/correction/corrected_channels.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace pmdsim {
namespace {

std::optional<Preview> preview_of(std::string_view channel) {
  if (channel == "range_m")
    return Preview{"range", ColourScale::sequential};
  if (channel == "correction_mm")
    return Preview{"correction", ColourScale::sequential};
  return std::nullopt;
}

} // namespace

CorrectedChannels::CorrectedChannels(const CorrectedImage &corrected, const Sensor &sensor)
    : status(corrected.status) {
  for (std::size_t pixel = 0; pixel < status.size(); ++pixel) {
    const glm::dvec3 point_m = corrected.range_m[pixel] * corrected.ray[pixel];
    range_m.push_back(static_cast<float>(corrected.range_m[pixel]));
    x_m.push_back(static_cast<float>(point_m.x));
    y_m.push_back(static_cast<float>(point_m.y));
    z_m.push_back(static_cast<float>(point_m.z));
    correction_mm.push_back(static_cast<float>(1e3 * corrected.correction_m[pixel]));
    normal_error_mm.push_back(static_cast<float>(1e3 * corrected.normal_error_m[pixel]));
    normals.emplace_back(sensor.world_from_camera.direction(corrected.normal[pixel]));
  }
  set.resolution = sensor.resolution;
  const std::array floats{&range_m, &x_m, &y_m, &z_m, &correction_mm, &normal_error_mm};
  for (std::size_t i = 0; i < corrected_channel_rows.size(); ++i) {
    const CorrectedChannelRow &row = corrected_channel_rows[i];
    Channel channel{std::string(row.name), std::string(row.unit), {}, {},
                    preview_of(row.name),  std::string(row.about)};
    if (i < floats.size())
      channel.values = std::span<const float>(*floats[i]);
    else
      channel.values = std::span<const std::uint32_t>(status);
    set.channels.push_back(std::move(channel));
  }
}

} // namespace pmdsim
