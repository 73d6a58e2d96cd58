#pragma once
// The light as the lens sees it: camera frame (x right, y down, z forward, origin at the lens), made in
// double before anything becomes float.

#include "engine/model/illuminator.h"
#include "engine/view/camera_scene.h"

#include <vector>

namespace pmdsim {

// An illuminator as the lens sees it.
struct CameraIlluminator {
  std::vector<Diode> diodes; // places and directions in the camera frame
  double modulation_phase_rad = 0.0;
  double modulation_depth = 1.0;
};

std::vector<CameraIlluminator> to_camera(const std::vector<Illuminator> &illuminators, const Sensor &sensor);

// True where no visible surface can turn its back to a diode: then nothing has to be asked in the sum.
bool all_face_the_light(const CameraScene &camera, const std::vector<CameraIlluminator> &illuminators);
// The same of anything within `box`, camera frame.
bool all_face(const CameraScene &camera, const VisibleBox &box);

} // namespace pmdsim
