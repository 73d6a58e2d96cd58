#pragma once
// A frame's measured distances as points in space.

#include "engine/model/sensor.h"
#include "host/output/files/channel.h"
#include "host/output/pictures/colour_map.h"

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace pmdsim {

// The channel whose distances become points: unwrapped_distance_m, else distance_m of the first frequency
// that has it, else range_m, as of a corrected image; null where there is none.
const Channel *distances_of_cloud(const ChannelSet &channels);
// The first of that quantity, of whichever frequency; null where there is none.
const Channel *first_of(const ChannelSet &channels, const std::string &quantity);

// The points that the camera takes its measurement for: at the measured distance along the ray through each
// pixel's centre, in the world frame. Bistatic deformation, noise and multipath displace them; the true
// points lie at range_m along the same rays. Pixels without a distance have none.
class PointCloud {
public:
  // Views of all three, which must outlive it. `channels` has distances (distances_of_cloud()).
  PointCloud(const Sensor &sensor, const ChannelSet &channels);

  const Sensor &sensor() const { return sensor_; }
  const ChannelSet &channels() const { return channels_; }
  const Channel &distance() const { return distance_; }
  // How they came about, for people: "as measured", "corrected" or "as the scene has it".
  const char *way_of_distances() const;

  // Calls use(index of the pixel, point), row by row.
  using Use = std::function<void(std::size_t pixel, const glm::dvec3 &point_m)>;
  void for_each(const Use &use) const;
  std::size_t count() const;

  // The amplitude that has the brightest colour, W/(m² sr): only 0.5 % of the pixels have more; nothing where
  // there is no amplitude.
  const std::optional<double> &brightest() const { return brightest_; }
  // The square root of amplitude over that, on viridis, so that far surfaces are not black; grey without
  // amplitude.
  Colour colour(std::size_t pixel) const;

private:
  const Sensor &sensor_;
  const ChannelSet &channels_;
  const Channel &distance_;
  std::span<const float> distances_m_, amplitudes_;
  std::optional<double> brightest_;
};

} // namespace pmdsim
