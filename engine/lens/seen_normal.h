#pragma once
// The normals that the lens sees.

#include "engine/model/scene.h"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace pmdsim {

// Of the shape with that id, below Scene::shape_count(): the triangle's geometric normal on the side of the
// lens, or the way from a disc to the lens; unit length, world frame, as `lens_m` is.
glm::dvec3 seen_normal(const Scene &scene, std::uint32_t id, const glm::dvec3 &lens_m);

// Of each pixel's shape; NaN where its id is no_id.
std::vector<glm::vec3> seen_normals(const Scene &scene, std::span<const std::uint32_t> ids,
                                    const glm::dvec3 &lens_m);

} // namespace pmdsim
