#pragma once
// Poses over time, as trackers and SLAM systems write them.

#include "engine/model/pose.h"
#include "host/input/file/input_error.h"

#include <filesystem>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace pmdsim {

// World from a moving frame. Between two poses positions go straight and rotations the shorter way round,
// each at constant speed; before the first pose and after the last it stands still.
struct Trajectory {
  std::vector<double> times_s; // strictly increasing, at least one
  std::vector<glm::dvec3> positions_m;
  std::vector<glm::dquat> rotations; // unit quaternions

  Pose at(double time_s) const;
};

inline constexpr std::size_t max_poses = 100'000;
inline constexpr std::size_t max_setup_poses = 2'000'000; // of all files of a setup

// A text file of one of these forms, at most max_poses poses:
//   TUM: lines of "time_s x_m y_m z_m qx qy qz qw", separated by blanks; # begins a comment
//   KITTI: lines of the twelve numbers of a 3 x 4 matrix, row by row; the first is of 0 s, the next of 1 s
//   and
//        so on
//   EuRoC: CSV whose header begins with #timestamp (nanoseconds) and names p_RS_R_x ... and q_RS_w ...
//   CSV: a header line, and columns that are named time_s, x_m, y_m, z_m, qx, qy, qz, qw, or as `rostopic
//   echo -p`
//        names a pose's: %time (nanoseconds) and ... position.x to orientation.w; other columns are left out
// Throws Error (input): `named_at` is the place that names the file.
Trajectory read_trajectory(const std::filesystem::path &file, const Place &named_at);

// By their names in a setup.
using Trajectories = std::map<std::string, std::shared_ptr<const Trajectory>>;

} // namespace pmdsim
