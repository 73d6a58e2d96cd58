#pragma once
// Poses that need no scene and no sensor to say where a frame is: matrices, quaternions, OpenCV's vectors,
// trajectories, and these the other way round or one after the other.

#include "engine/model/pose.h"
#include "host/input/file/input_error.h"
#include "host/input/setup/trajectory.h"

#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

namespace pmdsim {

// World from the frame at a time of
//   {"matrix"}                          rows of a 4 x 4 matrix
//   {"position_m", "quaternion_xyzw"}   of any length but 0
//   {"rvec", "tvec_m"}                  frame from world, as OpenCV's solvePnP gives it
//   {"trajectory"}                      one of `trajectories`
//   {"inverse"}                         one of the above the other way round
//   {"chain"}                           any of these one after the other, each in the frame of the one before
// The JSON has passed the schema. Throws Error (input) at `place`: a matrix that is no rotation and
// translation, a quaternion of length 0. `other` takes what is none of these, as a node in a chain; without
// it there is an error.
using OtherPose = std::function<Pose(const nlohmann::ordered_json &pose, const Place &place)>;
Pose free_pose(const nlohmann::ordered_json &pose, const Place &place, const Trajectories &trajectories,
               double time_s, const OtherPose &other = {});

// Calls `visit` with the name of each trajectory that a pose names, and its place.
using TrajectoryVisit = std::function<void(const std::string &name, const Place &place)>;
void for_each_trajectory(const nlohmann::ordered_json &pose, const Place &place,
                         const TrajectoryVisit &visit);

} // namespace pmdsim
