#include "host/output/clouds/cloud_picture.h"

#include "engine/lens/lens.h"
#include "host/output/pictures/image.h"
#include "host/output/pictures/key.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <vector>

namespace pmdsim {
namespace {

constexpr int picture_width = 820, picture_height = 660;
constexpr Box whole{16.0, 48.0, picture_width - 32.0, picture_height - 96.0};
constexpr Colour background{0.96, 0.96, 0.96};
constexpr double azimuth_rad = 0.75, elevation_rad = 0.45; // to the camera's left, and up
constexpr double distance_in_radii = 3.5;                  // from the cloud's middle
constexpr std::size_t largest_sample = 20'000;             // of points, to find where the cloud lies

// Every so many-th point.
std::vector<glm::dvec3> sample_of(const PointCloud &cloud) {
  const std::size_t step = cloud.count() / largest_sample + 1;
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

// Who looks at the cloud, and how: a place in the picture is scale * (x, y) / depth from its middle.
struct View {
  glm::dvec3 eye_m, right, down, forward; // world frame
  double scale = 1.0;
  glm::dvec2 shift{0.0}; // of the slopes
  double depth_m = 1.0;  // of the cloud's middle

  // x and y in the picture and the depth.
  glm::dvec3 project(const glm::dvec3 &point_m) const {
    const glm::dvec2 slope = slopes(point_m);
    return {whole.left + 0.5 * whole.width + scale * (slope.x - shift.x),
            whole.top + 0.5 * whole.height + scale * (slope.y - shift.y), depth(point_m)};
  }
  double depth(const glm::dvec3 &point_m) const { return glm::dot(point_m - eye_m, forward); }
  glm::dvec2 slopes(const glm::dvec3 &point_m) const {
    return glm::dvec2(glm::dot(point_m - eye_m, right), glm::dot(point_m - eye_m, down)) / depth(point_m);
  }
};

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

// Corners of a small pyramid with its tip in the lens, as the camera sees its image.
std::vector<glm::dvec3> camera_corners(const Sensor &sensor, double size_m) {
  const Lens lens(sensor);
  const glm::dvec2 far_corner(sensor.resolution);
  std::vector<glm::dvec3> corners;
  for (const glm::dvec2 &pixel :
       {glm::dvec2(0.0), glm::dvec2(far_corner.x, 0.0), far_corner, glm::dvec2(0.0, far_corner.y)})
    if (const auto ray = lens.ray(lens.on_chip_m(pixel)))
      corners.push_back(sensor.world_from_camera.rotation * (size_m * *ray) +
                        sensor.world_from_camera.translation_m);
  return corners;
}

View view_of(const Sensor &sensor, const Extent &extent, const std::vector<glm::dvec3> &shown) {
  const glm::dmat3 &camera = sensor.world_from_camera.rotation; // x right, y down, z forward
  View view;
  view.forward = camera * glm::dvec3(std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad),
                                     std::cos(azimuth_rad) * std::cos(elevation_rad));
  view.right = camera * glm::dvec3(std::cos(azimuth_rad), 0.0, -std::sin(azimuth_rad));
  view.down = glm::cross(view.forward, view.right);
  view.depth_m = distance_in_radii * extent.radius_m;
  view.eye_m = extent.middle_m - view.depth_m * view.forward;
  const Range x = range_along(shown, [&](const glm::dvec3 &point_m) { return view.slopes(point_m).x; });
  const Range y = range_along(shown, [&](const glm::dvec3 &point_m) { return view.slopes(point_m).y; });
  constexpr double filled = 0.9;
  view.shift = {0.5 * (x.min + x.max), 0.5 * (y.min + y.max)};
  view.scale =
      filled * std::min(whole.width / std::max(x.span(), 1e-9), whole.height / std::max(y.span(), 1e-9));
  return view;
}

// Colours and depths of the picture's pixels.
class DepthImage {
public:
  DepthImage()
      : colours_(std::size_t{columns} * rows, background),
        depths_m_(colours_.size(), std::numeric_limits<double>::infinity()) {}

  // A square of so many pixels a side.
  void put(const glm::dvec3 &place, int side, const Colour &colour) {
    const int left = static_cast<int>(std::floor(place.x - whole.left)) - side / 2;
    const int top = static_cast<int>(std::floor(place.y - whole.top)) - side / 2;
    for (int y = std::max(top, 0); y < std::min(top + side, rows); ++y)
      for (int x = std::max(left, 0); x < std::min(left + side, columns); ++x)
        if (const std::size_t at = static_cast<std::size_t>(y) * columns + static_cast<std::size_t>(x);
            place.z < depths_m_[at]) {
          depths_m_[at] = place.z;
          colours_[at] = colour;
        }
  }

  SurfacePtr surface() const {
    return make_image({columns, rows}, [&](std::uint32_t column, std::uint32_t row) {
      return colours_[std::size_t{row} * columns + column];
    });
  }

private:
  static constexpr int columns = static_cast<int>(whole.width), rows = static_cast<int>(whole.height);
  std::vector<Colour> colours_;
  std::vector<double> depths_m_;
};

// Neighbours in the frame touch in the picture, where the surface is not steep.
int side_of_points(const PointCloud &cloud, const Extent &extent, const View &view) {
  const glm::dvec2 &pitch_m = cloud.sensor().pixel_pitch_m;
  const double pixel_rad = std::max(pitch_m.x, pitch_m.y) / cloud.sensor().image_distance_m();
  const double away_m = glm::length(extent.middle_m - cloud.sensor().world_from_camera.translation_m);
  const double side = 1.6 * pixel_rad * away_m / view.depth_m * view.scale;
  constexpr double smallest = 1.0, largest = 12.0;
  return static_cast<int>(std::ceil(std::clamp(side, smallest, largest)));
}

void draw_camera(Canvas &canvas, const View &view, const Sensor &sensor,
                 const std::vector<glm::dvec3> &corners) {
  const auto place = [&](const glm::dvec3 &point_m) {
    const glm::dvec3 at = view.project(point_m);
    return std::pair(at.x, at.y);
  };
  const auto lens = place(sensor.world_from_camera.translation_m);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    canvas.line(lens, place(corners[i]), black, 1.5);
    canvas.line(place(corners[i]), place(corners[(i + 1) % corners.size()]), black, 1.5);
  }
  canvas.text(lens.first, lens.second + 14.0, "camera", Anchor::centre);
}

// A length at the depth of the cloud's middle, about a fifth of the picture's width.
void draw_scale(Canvas &canvas, const View &view) {
  const double pixels_a_metre = view.scale / view.depth_m;
  const double fifth_m = 0.2 * whole.width / pixels_a_metre;
  const double power = std::pow(10.0, std::floor(std::log10(fifth_m)));
  const double length_m = power * (fifth_m >= 5.0 * power ? 5.0 : fifth_m >= 2.0 * power ? 2.0 : 1.0);
  const double left = whole.left + 12.0, y = whole.bottom() - 14.0; // the camera is on the right
  const double right = left + length_m * pixels_a_metre;
  canvas.line({left, y}, {right, y}, black, 3.0);
  canvas.text(left, y - 14.0, value_text(length_m) + " m in the middle", Anchor::left);
}

std::string caption_of(const PointCloud &cloud) {
  std::string text = cloud.distance().name() + " as measured, seen from the side";
  if (cloud.brightest())
    text += fmt::format("; colour: square root of amplitude, yellow from {} W/(m² sr)",
                        value_text(*cloud.brightest()));
  return text;
}

} // namespace

Canvas draw_cloud(const PointCloud &cloud, const std::string &title) {
  Canvas canvas(picture_width, picture_height);
  canvas.title(whole.left, 22.0, title);
  canvas.fill(whole, background);
  std::vector<glm::dvec3> shown = sample_of(cloud);
  if (shown.empty()) {
    canvas.text(whole.left + 0.5 * whole.width, whole.top + 0.5 * whole.height, "no point", Anchor::centre);
    return canvas;
  }
  const Sensor &sensor = cloud.sensor();
  const Extent extent = extent_of(shown);
  const bool is_near = glm::length(sensor.world_from_camera.translation_m - extent.middle_m) <
                       0.7 * distance_in_radii * extent.radius_m;
  const std::vector<glm::dvec3> corners =
      is_near ? camera_corners(sensor, 0.15 * extent.radius_m) : std::vector<glm::dvec3>();
  // So often that it is no outlier.
  for (std::size_t i = shown.size() / 50 + 1; is_near && i > 0; --i)
    shown.push_back(sensor.world_from_camera.translation_m);
  const View view = view_of(sensor, extent, shown);
  DepthImage image;
  const int side = side_of_points(cloud, extent, view);
  cloud.for_each([&](std::size_t pixel, const glm::dvec3 &point_m) {
    if (const glm::dvec3 place = view.project(point_m); place.z > 0.0)
      image.put(place, side, cloud.colour(pixel));
  });
  const SurfacePtr pixels = image.surface();
  canvas.image(pixels.get(), whole);
  if (is_near)
    draw_camera(canvas, view, sensor, corners);
  draw_scale(canvas, view);
  canvas.outline(whole);
  canvas.text(whole.left, whole.bottom() + 22.0, caption_of(cloud), Anchor::left);
  return canvas;
}

} // namespace pmdsim
