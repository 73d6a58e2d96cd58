#include "host/output/profile.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <numbers>

namespace pmdsim {
namespace {

std::string csv_header(const ChannelSet &channels) {
  std::string header = "column,x_m,angle_deg";
  for (const Channel &channel : channels.channels)
    header += ',' + channel.name;
  return header + '\n';
}

} // namespace

std::uint32_t profile_row(const glm::uvec2 &resolution) { return resolution.y / 2; }

void write_profile_csv(OutputFile &file, const ChannelSet &channels, const Sensor &sensor) {
  const std::size_t row_start = std::size_t{profile_row(channels.resolution)} * channels.resolution.x;
  file.write(csv_header(channels));
  for (std::uint32_t column = 0; column < channels.resolution.x; ++column) {
    const double x_m = (column + 0.5 - channels.resolution.x / 2.0) * sensor.pixel_pitch_m.x;
    const double angle_deg = std::atan(x_m / sensor.image_distance_m()) * 180.0 / std::numbers::pi;
    std::string line = fmt::format("{},{},{}", column, x_m, angle_deg);
    for (const Channel &channel : channels.channels)
      std::visit(
          [&](auto values) { fmt::format_to(std::back_inserter(line), ",{}", values[row_start + column]); },
          channel.values);
    file.write(line + '\n');
  }
}

} // namespace pmdsim
