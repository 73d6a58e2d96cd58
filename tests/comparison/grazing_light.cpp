#include "tests/comparison/grazing_light.h"

#include "engine/reference/view/lens_model.h"
#include "tests/comparison/seen_plane.h"

#include <algorithm>
#include <cmath>

namespace pmdsim::test {

namespace {

bool grazes(const glm::dvec3 &point_m, const glm::dvec3 &normal, const Diode &diode) {
  const glm::dvec3 to_diode = glm::normalize(diode.position_m - point_m);
  // The tests' diagrams end at 90 degrees, too.
  const bool at_rim =
      diode.pattern.kind != Pattern::Kind::isotropic && std::abs(glm::dot(diode.axis, to_diode)) < 0.01;
  return at_rim || std::abs(glm::dot(normal, to_diode)) < 0.01;
}

} // namespace

std::vector<bool> pixels_in_grazing_light(const reference::Frame &frame, const Scene &scene,
                                          const Sensor &sensor, const Illuminator &illuminator) {
  const auto triangles = reference::triangles_in_camera(scene, sensor);
  const auto diodes = reference::diodes_in_camera(illuminator, sensor);
  const reference::LensModel lens(sensor);
  const glm::uvec2 samples = sensor.resolution * sensor.samples;
  std::vector<bool> grazing(sensor.pixel_count(), false);
  for (glm::uvec2 sample(0); sample.y < samples.y; ++sample.y)
    for (sample.x = 0; sample.x < samples.x; ++sample.x) {
      const std::uint32_t id = frame.sample_triangle_id[std::size_t{sample.y} * samples.x + sample.x];
      if (id == no_id)
        continue;
      const SeenPlane plane = plane_of(id, scene, sensor, triangles);
      const glm::dvec3 point_m = plane.meeting_point_m(*lens.sample_ray(sample));
      if (std::any_of(diodes.begin(), diodes.end(),
                      [&](const Diode &diode) { return grazes(point_m, plane.normal, diode); }))
        grazing[std::size_t{sample.y / sensor.samples} * sensor.resolution.x + sample.x / sensor.samples] =
            true;
    }
  return grazing;
}

} // namespace pmdsim::test
