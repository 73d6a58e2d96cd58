#pragma once
// Frames with shadows, and where their samples lie.

#include "engine/reference/reference.h"
#include "engine/reference/view/camera_frame.h"
#include "engine/reference/view/lens_model.h"
#include "tests/support/scenes.h"

namespace pmdsim::test {

inline constexpr reference::Options with_shadows{Shadows::automatic, true};

inline reference::Frame frame_of(const Scene &scene, const Sensor &sensor,
                                 const std::vector<Illuminator> &illuminators,
                                 const reference::Options &options = with_shadows) {
  return reference::simulate(scene, sensor, illuminators, Backscatter::lambert, options);
}

// Isotropic diodes in the frame of `sensor`.
inline Illuminator diodes_at(const Sensor &sensor, const std::vector<glm::dvec3> &positions_m) {
  Illuminator illuminator{"diodes", sensor.world_from_camera, {}};
  for (const glm::dvec3 &position_m : positions_m)
    illuminator.diodes.push_back(diode_at(position_m));
  return illuminator;
}

// `view_per_depth` metres wide at 1 m.
inline Sensor wide_sensor(const glm::uvec2 &resolution, double view_per_depth,
                          const Pose &world_from_camera = node_from_camera()) {
  Sensor sensor;
  sensor.resolution = resolution;
  sensor.focal_length_m = 0.1;
  sensor.pixel_pitch_m = view_per_depth * sensor.focal_length_m / glm::dvec2(resolution);
  sensor.world_from_camera = world_from_camera;
  return sensor;
}

// The place that the only sample of a pixel sees.
inline glm::dvec3 point_seen(const Sensor &sensor, const reference::Frame &frame, std::uint32_t pixel) {
  const std::uint32_t columns = sensor.resolution.x;
  return frame.range_m[pixel] * *reference::LensModel(sensor).sample_ray({pixel % columns, pixel / columns});
}

inline glm::dvec3 front_towards_lens(const reference::CameraTriangle &triangle, const glm::dvec3 &point_m) {
  const glm::dvec3 front = triangle.front();
  return glm::dot(front, point_m) < 0 ? front : -front;
}

} // namespace pmdsim::test
