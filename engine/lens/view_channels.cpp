#include "engine/lens/view_channels.h"

#include "engine/lens/lens.h"

#include <array>
#include <limits>
#include <tbb/parallel_for.h>

namespace pmdsim {
namespace {

const glm::dvec3 unknown(std::numeric_limits<double>::quiet_NaN());

// The three channels of a vector, in float and in double.
struct VectorChannels {
  std::array<std::vector<float> *, 3> rounded;
  std::array<std::vector<double> *, 3> unrounded;
  bool keeps_unrounded;

  void resize(std::size_t pixels) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      rounded[axis]->resize(pixels);
      unrounded[axis]->resize(keeps_unrounded ? pixels : 0);
    }
  }
  void set(std::size_t pixel, const glm::dvec3 &vector) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = vector[static_cast<glm::length_t>(axis)];
      (*rounded[axis])[pixel] = static_cast<float>(value);
      if (keeps_unrounded)
        (*unrounded[axis])[pixel] = value;
    }
  }
};

} // namespace

std::vector<glm::dvec3> rays_of(const Sensor &sensor) {
  const Lens lens(sensor);
  std::vector<glm::dvec3> rays(sensor.pixel_count());
  tbb::parallel_for(0u, sensor.resolution.y, [&](std::uint32_t row) {
    for (std::uint32_t column = 0; column < sensor.resolution.x; ++column)
      rays[std::size_t{row} * sensor.resolution.x + column] =
          lens.ray(lens.on_chip_m({column + 0.5, row + 0.5})).value_or(unknown);
  });
  return rays;
}

glm::dvec3 seen_normal(const Scene &scene, const Pose &camera_from_world, std::uint32_t shape) {
  const auto corner = [&](std::uint32_t vertex) {
    return camera_from_world.point(scene.positions_m[vertex]);
  };
  const bool is_disc = scene.is_disc(shape);
  const auto vertices = is_disc ? std::array<std::uint32_t, 3>{} : scene.triangles[shape].vertices;
  const glm::dvec3 first_m =
      corner(is_disc ? scene.discs[shape - scene.triangles.size()].vertex : vertices[0]);
  const glm::dvec3 normal =
      is_disc ? -first_m : glm::cross(corner(vertices[1]) - first_m, corner(vertices[2]) - first_m);
  const double length = glm::length(normal);
  if (!(length > 0.0))
    return unknown;
  return (glm::dot(normal, first_m) > 0.0 ? -1.0 : 1.0) / length * normal;
}

std::vector<glm::vec3> seen_normals_in_world(const Scene &scene, std::span<const std::uint32_t> shapes,
                                             const Pose &world_from_camera) {
  const Pose camera_from_world = inverse(world_from_camera);
  std::vector<glm::vec3> normals(shapes.size());
  tbb::parallel_for(std::size_t{0}, shapes.size(), [&](std::size_t pixel) {
    normals[pixel] =
        glm::vec3(shapes[pixel] == no_id
                      ? unknown
                      : world_from_camera.direction(seen_normal(scene, camera_from_world, shapes[pixel])));
  });
  return normals;
}

void add_rays(const Sensor &sensor, bool keep_unrounded, Measurement &frame) {
  const VectorChannels channels{{&frame.ray_x, &frame.ray_y, &frame.ray_z},
                                {&frame.unrounded_ray_x, &frame.unrounded_ray_y, &frame.unrounded_ray_z},
                                keep_unrounded};
  const std::vector<glm::dvec3> rays = rays_of(sensor);
  channels.resize(rays.size());
  for (std::size_t pixel = 0; pixel < rays.size(); ++pixel)
    channels.set(pixel, rays[pixel]);
}

void add_normals(const Scene &scene, const Sensor &sensor, bool keep_unrounded, Measurement &frame) {
  const VectorChannels channels{
      {&frame.normal_x, &frame.normal_y, &frame.normal_z},
      {&frame.unrounded_normal_x, &frame.unrounded_normal_y, &frame.unrounded_normal_z},
      keep_unrounded};
  const Pose camera_from_world = inverse(sensor.world_from_camera);
  channels.resize(frame.triangle_id.size());
  tbb::parallel_for(std::size_t{0}, frame.triangle_id.size(), [&](std::size_t pixel) {
    const std::uint32_t shape = frame.triangle_id[pixel];
    channels.set(pixel, shape == no_id ? unknown : seen_normal(scene, camera_from_world, shape));
  });
}

} // namespace pmdsim
