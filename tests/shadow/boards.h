#pragma once
// Boards of diodes of several kinds, and a camera that stands anyhow.

#include "engine/model/illuminator.h"
#include "engine/model/sensor.h"
#include "tests/support/random_scenes.h"
#include "tests/support/scenes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <vector>

namespace pmdsim::test {

// Places in the camera's frame.
using Places = std::vector<glm::dvec3>;

// Three rings across the view.
inline Places rings_about(const glm::dvec3 &centre_m, std::size_t count) {
  Places places_m;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        2.0 * std::numbers::pi * (static_cast<double>(i / 3) + 0.5) / static_cast<double>(count / 3);
    const double radius_m = 0.06 + 0.04 * static_cast<double>(i % 3);
    places_m.push_back(centre_m + radius_m * glm::dvec3(std::cos(angle), std::sin(angle), 0.0));
  }
  return places_m;
}
inline Places rings(double z_m, std::size_t count) { return rings_about({0.0, 0.0, z_m}, count); }

inline Places moved(Places places_m, const glm::dmat3 &rotation, const glm::dvec3 &by_m) {
  for (glm::dvec3 &place_m : places_m)
    place_m = rotation * place_m + by_m;
  return places_m;
}

inline glm::dmat3 tilt(double rad) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), rad, glm::dvec3(0.3, 1.0, 0.1)));
}

inline std::vector<Illuminator> illuminators_of(const std::vector<Places> &boards, const Sensor &sensor) {
  std::vector<Illuminator> illuminators;
  for (const Places &places_m : boards) {
    illuminators.push_back({"board", sensor.world_from_camera, {}});
    for (const glm::dvec3 &place_m : places_m)
      illuminators.back().diodes.push_back(diode_at(place_m));
  }
  return illuminators;
}

inline Sensor tumbled_camera(std::uint32_t seed, std::uint32_t pixels) {
  Random random(seed);
  Sensor sensor;
  sensor.resolution = {pixels, pixels};
  sensor.pixel_pitch_m = glm::dvec2(0.02 / pixels);
  sensor.focal_length_m = 0.02;
  sensor.world_from_camera = random.pose(3.0);
  return sensor;
}

} // namespace pmdsim::test
