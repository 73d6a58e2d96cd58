#include "host/output/clouds/cloud.h"

#include "engine/lens/lens.h"
#include "host/output/pictures/colouring.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pmdsim {
namespace {

std::span<const float> floats_of(const Channel *channel) {
  return channel ? std::get<std::span<const float>>(channel->values) : std::span<const float>();
}

const Channel &required_distances(const ChannelSet &channels) {
  const Channel *distances = distances_of_cloud(channels);
  if (!distances)
    throw std::logic_error("a point cloud of a frame without distances");
  return *distances;
}

} // namespace

const Channel *first_of(const ChannelSet &channels, const std::string &quantity) {
  const auto found = std::ranges::find(channels.channels, quantity, &Channel::quantity);
  return found == channels.channels.end() ? nullptr : &*found;
}

const Channel *distances_of_cloud(const ChannelSet &channels) {
  for (const char *quantity : {"unwrapped_distance_m", "distance_m", "range_m"})
    if (const Channel *found = first_of(channels, quantity))
      return found;
  return nullptr;
}

PointCloud::PointCloud(const Sensor &sensor, const ChannelSet &channels)
    : sensor_(sensor), channels_(channels), distance_(required_distances(channels)),
      distances_m_(floats_of(&distance_)), amplitudes_(floats_of(first_of(channels, "amplitude"))) {
  if (const ValueSpread spread = spread_of_values(amplitudes_); !spread.is_empty())
    brightest_ = std::max(spread.robust.max, 0.0);
}

const char *PointCloud::way_of_distances() const {
  if (distance_.quantity != "range_m")
    return "as measured";
  return first_of(channels_, "correction_mm") ? "corrected" : "as the scene has it";
}

void PointCloud::for_each(const Use &use) const {
  const Lens lens(sensor_);
  const Pose &world_from_camera = sensor_.world_from_camera;
  const glm::uvec2 &resolution = channels_.resolution;
  for (std::uint32_t row = 0; row < resolution.y; ++row)
    for (std::uint32_t column = 0; column < resolution.x; ++column) {
      const std::size_t pixel = std::size_t{row} * resolution.x + column;
      const auto distance_m = static_cast<double>(distances_m_[pixel]);
      if (!std::isfinite(distance_m))
        continue;
      if (const auto ray = lens.ray(lens.on_chip_m({column + 0.5, row + 0.5})))
        use(pixel, world_from_camera.rotation * (distance_m * *ray) + world_from_camera.translation_m);
    }
}

std::size_t PointCloud::count() const {
  std::size_t count = 0;
  for_each([&](std::size_t, const glm::dvec3 &) { ++count; });
  return count;
}

Colour PointCloud::colour(std::size_t pixel) const {
  if (!brightest_ || *brightest_ <= 0.0 || !std::isfinite(amplitudes_[pixel]))
    return no_value_colour;
  return viridis.at(std::sqrt(std::max(0.0, static_cast<double>(amplitudes_[pixel]) / *brightest_)));
}

} // namespace pmdsim
