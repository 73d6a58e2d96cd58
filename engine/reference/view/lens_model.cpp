#include "engine/reference/view/lens_model.h"

#include <algorithm>

namespace pmdsim::reference {

namespace {

// D1(alpha) D2(beta) D3(gamma): active, right-handed rotations about x, y and z.
glm::dmat3 chip_rotation(const glm::dvec3 &angles_rad) {
  const glm::dvec3 c = glm::cos(angles_rad), s = glm::sin(angles_rad);
  const glm::dmat3 d1({1, 0, 0}, {0, c.x, s.x}, {0, -s.x, c.x});
  const glm::dmat3 d2({c.y, 0, -s.y}, {0, 1, 0}, {s.y, 0, c.y});
  const glm::dmat3 d3({c.z, s.z, 0}, {-s.z, c.z, 0}, {0, 0, 1});
  return d1 * d2 * d3;
}

using AnyLens = std::variant<PinholeLens, BrownConradyLens, FisheyeLens>;

AnyLens lens_with(std::monostate) { return PinholeLens(); }
AnyLens lens_with(const BrownConrady &distortion) { return BrownConradyLens(distortion); }
AnyLens lens_with(const Fisheye &distortion) { return FisheyeLens(distortion); }

double from_pixel_centre(std::uint32_t sample, std::uint32_t samples_per_pixel) {
  return (sample % samples_per_pixel + 0.5) / samples_per_pixel - 0.5;
}

} // namespace

LensModel::LensModel(const Sensor &sensor)
    : resolution_(sensor.resolution), pitch_m_(sensor.pixel_pitch_m), fill_factor_(sensor.fill_factor),
      samples_(sensor.samples), chip_rotation_(chip_rotation(sensor.chip.rotation_rad)),
      origin_m_(glm::dvec3(0, 0, sensor.image_distance_m()) + sensor.chip.translation_m),
      lens_(std::visit([](const auto &distortion) { return lens_with(distortion); }, sensor.distortion)),
      vignetting_(sensor.vignetting) {}

std::optional<glm::dvec3> LensModel::sample_ray(const glm::uvec2 &sample) const {
  const glm::dvec3 place = place_m(sample_on_chip_m(sample));
  if (!(place.z > 0))
    return std::nullopt;
  const auto ray = std::visit([&](const auto &lens) { return lens.ray(place); }, lens_);
  return ray ? std::optional(glm::normalize(*ray)) : std::nullopt;
}

glm::dvec2 LensModel::sample_on_chip_m(const glm::uvec2 &sample) const {
  const glm::dvec2 pixel(sample / samples_);
  const glm::dvec2 in_pixel(from_pixel_centre(sample.x, samples_), from_pixel_centre(sample.y, samples_));
  return (pixel + 0.5 - 0.5 * resolution_ + in_pixel * fill_factor_) * pitch_m_;
}

std::optional<glm::dvec2> LensModel::slopes(const glm::dvec3 &ray) const {
  return std::visit([&](const auto &lens) { return lens.slopes(ray); }, lens_);
}

double LensModel::vignetting_gain(const glm::dvec3 &ray) const {
  if (vignetting_ == Vignetting::none)
    return 1.0;
  const double cosine = std::max(ray.z, 0.0);
  return cosine * cosine * cosine * cosine;
}

} // namespace pmdsim::reference
