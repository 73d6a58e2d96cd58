#include "engine/lens/seen_normal.h"

#include <limits>

namespace pmdsim {

glm::dvec3 seen_normal(const Scene &scene, std::uint32_t id, const glm::dvec3 &lens_m) {
  if (scene.is_disc(id))
    return glm::normalize(lens_m - scene.positions_m[scene.discs[id - scene.triangles.size()].vertex]);
  const auto [a, b, c] = scene.triangles[id].vertices;
  const glm::dvec3 origin = scene.positions_m[a];
  const glm::dvec3 normal =
      glm::normalize(glm::cross(scene.positions_m[b] - origin, scene.positions_m[c] - origin));
  return glm::dot(normal, lens_m - origin) < 0.0 ? -normal : normal;
}

std::vector<glm::vec3> seen_normals(const Scene &scene, std::span<const std::uint32_t> ids,
                                    const glm::dvec3 &lens_m) {
  std::vector<glm::vec3> normals;
  normals.reserve(ids.size());
  for (const std::uint32_t id : ids)
    normals.push_back(id < scene.shape_count() ? glm::vec3(seen_normal(scene, id, lens_m))
                                               : glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  return normals;
}

} // namespace pmdsim
