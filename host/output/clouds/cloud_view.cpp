#include "host/output/clouds/cloud_view.h"

#include "engine/lens/lens.h"
#include "host/output/pictures/axis.h"

#include <algorithm>
#include <cmath>

namespace pmdsim {
namespace {

constexpr double azimuth_rad = 0.75, elevation_rad = 0.45; // to the camera's left, and up
constexpr double distance_in_radii = 3.5;                  // from the cloud's middle
constexpr std::size_t largest_sample = 20'000;             // of points, to find where the cloud lies

// Every so many-th point.
std::vector<glm::dvec3> sample_of(const PointCloud &cloud) {
  const std::size_t step = cloud.sensor().pixel_count() / largest_sample + 1;
  std::vector<glm::dvec3> sample;
  std::size_t number = 0;
  cloud.for_each([&](std::size_t, const glm::dvec3 &point_m) {
    if (number++ % step == 0)
      sample.push_back(point_m);
  });
  return sample;
}

// Where all values lie but the outermost hundredth on either side.
Range middle_part(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t left_out = values.size() / 100;
  return {values[left_out], values[values.size() - 1 - left_out]};
}

template <class Value>
Range range_along(const std::vector<glm::dvec3> &points_m, const Value &value) {
  std::vector<double> values;
  values.reserve(points_m.size());
  for (const glm::dvec3 &point_m : points_m)
    values.push_back(value(point_m));
  return middle_part(std::move(values));
}

// The middle of the cloud and how far it reaches.
struct Extent {
  glm::dvec3 middle_m;
  double radius_m;
};

Extent extent_of(const std::vector<glm::dvec3> &sample) {
  Extent extent{glm::dvec3(0.0), 0.0};
  for (glm::length_t i = 0; i < 3; ++i) {
    const Range range = range_along(sample, [&](const glm::dvec3 &point_m) { return point_m[i]; });
    extent.middle_m[i] = 0.5 * (range.min + range.max);
    extent.radius_m = std::hypot(extent.radius_m, 0.5 * range.span());
  }
  extent.radius_m = std::max(extent.radius_m, 1e-6 * (1.0 + glm::length(extent.middle_m)));
  return extent;
}

// The lens, and the corners of its image so far before it.
std::vector<glm::dvec3> camera_of(const Sensor &sensor, double size_m) {
  const Lens lens(sensor);
  const glm::dvec2 last(sensor.resolution);
  std::vector<glm::dvec3> camera_m{sensor.world_from_camera.translation_m};
  for (const glm::dvec2 &pixel : {glm::dvec2(0.0), glm::dvec2(last.x, 0.0), last, glm::dvec2(0.0, last.y)})
    if (const auto ray = lens.ray(lens.on_chip_m(pixel)))
      camera_m.push_back(sensor.world_from_camera.rotation * (size_m * *ray) + camera_m.front());
  return camera_m;
}

} // namespace

CloudView::CloudView(const PointCloud &cloud, const glm::dvec2 &size) {
  std::vector<glm::dvec3> shown = sample_of(cloud);
  has_points_ = !shown.empty();
  if (!has_points_)
    return;
  const Sensor &sensor = cloud.sensor();
  const glm::dvec3 &lens_m = sensor.world_from_camera.translation_m;
  const auto [middle_m, radius_m] = extent_of(shown);
  const double away_m = glm::length(lens_m - middle_m);
  turn_to(sensor.world_from_camera.rotation, middle_m, radius_m);
  if (away_m < 0.7 * depth_m_)
    camera_m_ = camera_of(sensor, 0.15 * radius_m);
  const std::size_t no_outlier = shown.size() / 50 + 1;
  if (!camera_m_.empty())
    shown.insert(shown.end(), no_outlier, lens_m);
  fit(shown, size);
  const double pixel_rad =
      std::max(sensor.pixel_pitch_m.x, sensor.pixel_pitch_m.y) / sensor.image_distance_m();
  constexpr double smallest = 1.0, largest = 12.0;
  point_side_ =
      static_cast<int>(std::ceil(std::clamp(1.6 * pixel_rad * away_m * pixels_a_metre(), smallest, largest)));
}

void CloudView::turn_to(const glm::dmat3 &world_from_camera, const glm::dvec3 &middle_m, double radius_m) {
  const double level = std::cos(elevation_rad);
  forward_ = world_from_camera * glm::dvec3(std::sin(azimuth_rad) * level, std::sin(elevation_rad),
                                            std::cos(azimuth_rad) * level);
  right_ = world_from_camera * glm::dvec3(std::cos(azimuth_rad), 0.0, -std::sin(azimuth_rad));
  down_ = glm::cross(forward_, right_);
  depth_m_ = distance_in_radii * radius_m;
  eye_m_ = middle_m - depth_m_ * forward_;
}

void CloudView::fit(const std::vector<glm::dvec3> &shown, const glm::dvec2 &size) {
  constexpr double filled = 0.9, least_span = 1e-9;
  const Range x = range_along(shown, [&](const glm::dvec3 &point_m) { return slopes(point_m).x; });
  const Range y = range_along(shown, [&](const glm::dvec3 &point_m) { return slopes(point_m).y; });
  scale_ =
      filled * std::min(size.x / std::max(x.span(), least_span), size.y / std::max(y.span(), least_span));
  middle_ = 0.5 * size - 0.5 * scale_ * glm::dvec2(x.min + x.max, y.min + y.max);
}

glm::dvec2 CloudView::slopes(const glm::dvec3 &point_m) const {
  const glm::dvec3 from_eye_m = point_m - eye_m_;
  return glm::dvec2(glm::dot(from_eye_m, right_), glm::dot(from_eye_m, down_)) /
         glm::dot(from_eye_m, forward_);
}

glm::dvec3 CloudView::place(const glm::dvec3 &point_m) const {
  return {middle_ + scale_ * slopes(point_m), glm::dot(point_m - eye_m_, forward_)};
}

} // namespace pmdsim
