#include "host/input/setup/free_pose.h"

#include "host/input/file/json_file.h"
#include "host/input/gltf/nodes.h"
#include "host/input/setup/rotations.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

// Rows of a 4 x 4 matrix, whose rotation may be rounded to six digits.
Pose by_matrix(const ordered_json &rows, const Place &place) {
  constexpr double rounding = 1e-5;
  glm::dmat4 matrix;
  for (glm::length_t row = 0; row < 4; ++row)
    for (glm::length_t column = 0; column < 4; ++column)
      matrix[column][row] =
          rows.at(static_cast<std::size_t>(row)).at(static_cast<std::size_t>(column)).get<double>();
  const auto affine = affine_transform(matrix);
  if (!affine)
    throw input_error(place / 3, "expected the last row to be 0, 0, 0, 1");
  const auto rotation = rotation_of(affine->linear);
  bool is_rigid = rotation.has_value();
  for (glm::length_t axis = 0; is_rigid && axis < 3; ++axis)
    is_rigid = glm::length((*rotation)[axis] - affine->linear[axis]) <= rounding;
  if (!is_rigid)
    throw input_error(place,
                      "expected a rotation and a translation, found a matrix that scales, shears or mirrors");
  return {*rotation, affine->translation_m};
}

Pose by_quaternion(const ordered_json &pose, const Place &place) {
  const auto q = pose.at("quaternion_xyzw").get<std::vector<double>>();
  const double largest = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
  if (!(largest > 0.0))
    throw input_error(place / "quaternion_xyzw", "expected a rotation, found zero");
  const glm::dquat rotation(q[3] / largest, q[0] / largest, q[1] / largest, q[2] / largest);
  return {glm::mat3_cast(glm::normalize(rotation)), pose.at("position_m").get<glm::dvec3>()};
}

// Rodrigues' formula; OpenCV's extrinsics take points of the world to the camera.
Pose by_opencv(const ordered_json &pose) {
  const auto rvec = pose.at("rvec").get<glm::dvec3>();
  const double angle_rad = glm::length(rvec);
  const glm::dvec3 axis = angle_rad > 0.0 ? rvec / angle_rad : glm::dvec3(1.0, 0.0, 0.0);
  return inverse(Pose{glm::mat3_cast(glm::angleAxis(angle_rad, axis)), pose.at("tvec_m").get<glm::dvec3>()});
}

} // namespace

Pose free_pose(const ordered_json &pose, const Place &place, const Trajectories &trajectories, double time_s,
               const OtherPose &other) {
  if (pose.contains("matrix"))
    return by_matrix(pose.at("matrix"), place / "matrix");
  if (pose.contains("quaternion_xyzw"))
    return by_quaternion(pose, place);
  if (pose.contains("rvec"))
    return by_opencv(pose);
  if (pose.contains("trajectory"))
    return trajectories.at(pose.at("trajectory").get<std::string>())->at(time_s);
  if (pose.contains("inverse"))
    return inverse(free_pose(pose.at("inverse"), place / "inverse", trajectories, time_s));
  if (!pose.contains("chain")) {
    if (!other)
      throw input_error(place, "expected a pose that needs no node of the scene");
    return other(pose, place);
  }
  const ordered_json &links = pose.at("chain");
  Pose world_from_link;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (i > 0 && links[i].contains("node"))
      throw input_error(place / "chain" / i,
                        "expected a node as the first of the chain alone, as it stands in the world");
    world_from_link =
        compose(world_from_link, free_pose(links[i], place / "chain" / i, trajectories, time_s, other));
  }
  return world_from_link;
}

void for_each_trajectory(const ordered_json &pose, const Place &place, const TrajectoryVisit &visit) {
  if (pose.contains("trajectory"))
    visit(pose.at("trajectory").get<std::string>(), place / "trajectory");
  if (pose.contains("inverse"))
    for_each_trajectory(pose.at("inverse"), place / "inverse", visit);
  if (pose.contains("chain"))
    for (std::size_t i = 0; i < pose.at("chain").size(); ++i)
      for_each_trajectory(pose.at("chain").at(i), place / "chain" / i, visit);
}

} // namespace pmdsim
