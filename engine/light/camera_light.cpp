#include "engine/light/camera_light.h"

#include <algorithm>

namespace pmdsim {

std::vector<CameraIlluminator> to_camera(const std::vector<Illuminator> &illuminators, const Sensor &sensor) {
  std::vector<CameraIlluminator> seen;
  for (const Illuminator &illuminator : illuminators) {
    const Pose camera_from_illuminator =
        compose(inverse(sensor.world_from_camera), illuminator.world_from_illuminator);
    seen.push_back({illuminator.diodes, illuminator.modulation_phase_rad, illuminator.modulation_depth});
    for (Diode &diode : seen.back().diodes) {
      diode.position_m = camera_from_illuminator.point(diode.position_m);
      diode.axis = camera_from_illuminator.direction(diode.axis);
      diode.across = camera_from_illuminator.direction(diode.across);
    }
  }
  return seen;
}

// Asked of each illuminator's own box: one around all of them would hold much more than their diodes.
bool all_face_the_light(const CameraScene &camera, const std::vector<CameraIlluminator> &illuminators) {
  return std::ranges::all_of(illuminators, [&](const CameraIlluminator &illuminator) {
    VisibleBox box;
    for (const Diode &diode : illuminator.diodes)
      box.add(diode.position_m);
    return all_face(camera, box);
  });
}

bool all_face(const CameraScene &camera, const VisibleBox &box) {
  const glm::dvec3 centre = 0.5 * (box.low_m + box.high_m);
  const double radius_m = glm::distance(centre, box.high_m);
  return std::ranges::all_of(camera.planes, [&](const Plane &plane) {
    return glm::dot(plane.normal, centre) - plane.offset_m > radius_m;
  });
}

} // namespace pmdsim
