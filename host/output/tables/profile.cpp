#include "host/output/tables/profile.h"

#include "engine/lens/lens.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <limits>
#include <string>
#include <variant>

namespace pmdsim {
namespace {

std::string csv_header(const ChannelSet &channels) {
  std::string header = "column,chip_x_m,angle_deg";
  for (const Channel &channel : channels.channels)
    header += ',' + channel.name();
  return header + '\n';
}

// Seen from above: of the ray's projection onto the plane of x and z.
double angle_deg(const std::optional<glm::dvec3> &ray) {
  return ray ? glm::degrees(std::atan2(ray->x, ray->z)) : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

std::uint32_t profile_row(const glm::uvec2 &resolution) { return resolution.y / 2; }

void write_profile_csv(OutputFile &file, const ChannelSet &channels, const Sensor &sensor) {
  const Lens lens(sensor);
  const std::uint32_t row = profile_row(channels.resolution);
  const std::size_t row_start = std::size_t{row} * channels.resolution.x;
  file.write(csv_header(channels));
  for (std::uint32_t column = 0; column < channels.resolution.x; ++column) {
    const glm::dvec2 chip_m = lens.on_chip_m({column + 0.5, row + 0.5});
    std::string line = fmt::format("{},{},{}", column, chip_m.x, angle_deg(lens.ray(chip_m)));
    for (const Channel &channel : channels.channels)
      std::visit(
          [&](auto values) { fmt::format_to(std::back_inserter(line), ",{}", values[row_start + column]); },
          written_values(channel));
    file.write(line + '\n');
  }
}

} // namespace pmdsim
