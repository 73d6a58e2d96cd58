#include "host/report/field_of_view.h"

#include "engine/lens/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pmdsim {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Places count columns and rows from the image's top left corner.
class Image {
public:
  explicit Image(const Sensor &sensor) : lens_(sensor), size_(sensor.resolution) {}

  // `part` of the image's width and height.
  glm::dvec2 place(const glm::dvec2 &part) const { return part * size_; }
  // Unit length, or NaN.
  glm::dvec3 ray(const glm::dvec2 &place) const {
    return lens_.ray(lens_.on_chip_m(place)).value_or(glm::dvec3(nan));
  }
  // From `part` over the centre to the place opposite.
  double angle_across_deg(const glm::dvec2 &part) const {
    const glm::dvec3 centre = ray(place(glm::dvec2(0.5)));
    return angle_deg(ray(place(part)), centre) + angle_deg(centre, ray(place(1.0 - part)));
  }

private:
  // Precise for small angles too, as an arc cosine is not.
  static double angle_deg(const glm::dvec3 &a, const glm::dvec3 &b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
  }

  Lens lens_;
  glm::dvec2 size_;
};

// Between where the rays through two places meet the plane z = 1 m.
double distance_at_1m_m(const Image &image, const glm::dvec2 &from, const glm::dvec2 &to) {
  const glm::dvec3 a = image.ray(from), b = image.ray(to);
  return a.z > 0.0 && b.z > 0.0 ? glm::distance(a / a.z, b / b.z) : nan;
}

double darkest_corner(const Image &image, Vignetting vignetting) {
  if (vignetting == Vignetting::none)
    return 1.0;
  double darkest = 1.0;
  for (const glm::dvec2 corner : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1), glm::dvec2(1, 1)})
    darkest = std::min(darkest, std::pow(std::max(0.0, image.ray(image.place(corner)).z), 4.0));
  return darkest;
}

} // namespace

FieldOfView field_of_view(const Sensor &sensor) {
  const Image image(sensor);
  const glm::dvec2 centre = image.place(glm::dvec2(0.5)), column(0.5, 0.0), row(0.0, 0.5);
  return {image.angle_across_deg({0.0, 0.5}),
          image.angle_across_deg({0.5, 0.0}),
          std::fmax(image.angle_across_deg({0.0, 0.0}), image.angle_across_deg({0.0, 1.0})),
          {distance_at_1m_m(image, centre - column, centre + column),
           distance_at_1m_m(image, centre - row, centre + row)},
          darkest_corner(image, sensor.vignetting)};
}

Sensor coarser(Sensor sensor, double factor) {
  if (factor <= 1.0)
    return sensor;
  const glm::uvec2 fewest = glm::min(sensor.resolution, glm::uvec2(8));
  const glm::uvec2 resolution = glm::max(glm::uvec2(glm::dvec2(sensor.resolution) / factor), fewest);
  sensor.pixel_pitch_m *= glm::dvec2(sensor.resolution) / glm::dvec2(resolution);
  sensor.resolution = resolution;
  return sensor;
}

} // namespace pmdsim
