#pragma once
// What the lens and the scene's geometry alone tell of each pixel: the way that it looks, and the normal of
// what it sees.

#include "engine/model/measurement.h"
#include "engine/model/scene.h"
#include "engine/model/sensor.h"

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

// The unit vectors from the lens through the pixels' centres, row by row, in the camera frame; NaN where a
// pixel has no ray.
std::vector<glm::dvec3> rays_of(const Sensor &sensor);

// The geometric normal of a shape of the scene in the camera frame, unit length, turned to the lens; of a
// disc, which faces the lens, the way there. NaN of a triangle without area.
glm::dvec3 seen_normal(const Scene &scene, const Pose &camera_from_world, std::uint32_t shape);

// The same in the world frame, of each pixel's shape; NaN where its id is no_id.
std::vector<glm::vec3> seen_normals_in_world(const Scene &scene, std::span<const std::uint32_t> shapes,
                                             const Pose &world_from_camera);

// Fills Measurement::ray_x and the like, from the sensor alone.
void add_rays(const Sensor &sensor, bool keep_unrounded, Measurement &frame);
// Fills Measurement::normal_x and the like, from Measurement::triangle_id, in a scene as it was then.
void add_normals(const Scene &scene, const Sensor &sensor, bool keep_unrounded, Measurement &frame);

} // namespace pmdsim
