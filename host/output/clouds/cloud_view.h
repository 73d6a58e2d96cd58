#pragma once
// Where the observer of a point cloud stands, and what that makes of its points.

#include "host/output/clouds/cloud.h"

#include <glm/glm.hpp>
#include <vector>

namespace pmdsim {

// In perspective, from the left of the camera and above it: towards the middle of the cloud, whose outermost
// points fill most of the picture. Places count pixels from the picture's top left corner.
class CloudView {
public:
  // Of a picture of this size. A cloud without points is seen from somewhere.
  CloudView(const PointCloud &cloud, const glm::dvec2 &size);

  // x and y in the picture and the depth, which is negative behind the observer.
  glm::dvec3 place(const glm::dvec3 &point_m) const;
  // A length at the depth of the cloud's middle.
  double pixels_a_metre() const { return scale_ / depth_m_; }
  // A square of so many pixels a side for a point: neighbours in the frame touch where a surface is not
  // steep.
  int point_side() const { return point_side_; }
  bool has_points() const { return has_points_; }
  // The lens and the corners of a small pyramid through which it sees; none where the camera is far off.
  const std::vector<glm::dvec3> &camera_m() const { return camera_m_; }

private:
  void turn_to(const glm::dmat3 &world_from_camera, const glm::dvec3 &middle_m, double radius_m);
  void fit(const std::vector<glm::dvec3> &shown, const glm::dvec2 &size);
  glm::dvec2 slopes(const glm::dvec3 &point_m) const;

  glm::dvec3 eye_m_{0.0}, right_{1.0, 0.0, 0.0}, down_{0.0, 1.0, 0.0}, forward_{0.0, 0.0, 1.0};
  double depth_m_ = 1.0; // of the cloud's middle
  double scale_ = 1.0;   // pixels a slope
  glm::dvec2 middle_{0.0};
  int point_side_ = 1;
  bool has_points_ = false;
  std::vector<glm::dvec3> camera_m_;
};

} // namespace pmdsim
