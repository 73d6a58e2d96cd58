#include "host/input/file/json_file.h"
#include "host/input/schema/limits.h"
#include "host/input/setup/parts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr double smallest_sine = 1e-9; // directions closer than this, in radians, count as parallel

// Unit vector along `v`; nothing where `v` has no direction. Free of overflow and underflow.
std::optional<glm::dvec3> direction_of(const glm::dvec3 &v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0) || !std::isfinite(largest))
    return std::nullopt;
  return glm::normalize(v / largest);
}

Pose looking_at(const ordered_json &pose, const Place &place) {
  const auto position_m = pose.at("position_m").get<glm::dvec3>();
  const auto forward = direction_of(pose.at("look_at_m").get<glm::dvec3>() - position_m);
  if (!forward)
    throw input_error(place / "look_at_m", "expected a point other than position_m");
  const auto up = direction_of(pose.at("up").get<glm::dvec3>());
  if (!up)
    throw input_error(place / "up", "expected a direction, found zero");
  const glm::dvec3 right = glm::cross(*forward, *up);
  if (glm::length(right) < smallest_sine)
    throw input_error(place / "up", "expected a direction across the view, found one along it");
  const glm::dvec3 x = glm::normalize(right);
  return {glm::dmat3(x, glm::cross(*forward, x), *forward), position_m};
}

// The rotation nearest in spirit: z, the view axis, is kept, y is turned only as far as shear requires.
std::optional<glm::dmat3> rotation_of(const glm::dmat3 &linear) {
  const auto z = direction_of(linear[2]);
  const auto y_sheared = direction_of(linear[1]);
  const auto x_sheared = direction_of(linear[0]);
  if (!x_sheared || !y_sheared || !z)
    return std::nullopt;
  const glm::dvec3 y = *y_sheared - glm::dot(*y_sheared, *z) * *z;
  if (glm::length(y) < smallest_sine ||
      glm::determinant(glm::dmat3(*x_sheared, *y_sheared, *z)) < smallest_sine)
    return std::nullopt;
  const glm::dvec3 y_unit = glm::normalize(y);
  return glm::dmat3(glm::cross(y_unit, *z), y_unit, *z);
}

Pose at_node(const std::string &name, const Place &place, const GltfScene &scene) {
  const std::string quoted = in_quotes(name), file = scene.file.string();
  const auto node = std::ranges::find(scene.nodes, name, &NamedNode::name);
  if (node == scene.nodes.end())
    throw input_error(place, fmt::format("no node {} in {}", quoted, file));
  if (std::ranges::count(scene.nodes, name, &NamedNode::name) > 1)
    throw input_error(place, fmt::format("more than one node {} in {}", quoted, file));
  if (!is_position(node->world_from_node.translation_m))
    throw input_error(place,
                      fmt::format("node {} lies outside the world, expected coordinates from {} to {} m",
                                  quoted, -max_coordinate_m, max_coordinate_m));
  const auto rotation = rotation_of(node->world_from_node.linear);
  if (!rotation)
    throw input_error(place, fmt::format("the transform of node {} is mirrored or singular", quoted));
  return compose({*rotation, node->world_from_node.translation_m}, node_from_camera());
}

Pose at_sensor(const std::string &name, const Place &place, const std::vector<Sensor> &sensors) {
  const auto sensor = std::ranges::find(sensors, name, &Sensor::name);
  if (sensor == sensors.end())
    throw input_error(place, fmt::format("no sensor {} in this setup", in_quotes(name)));
  return sensor->world_from_camera;
}

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

// {"matrix"} or {"trajectory"}.
Pose free_pose(const ordered_json &pose, const Place &place, const Trajectories &trajectories,
               double time_s) {
  if (pose.contains("matrix"))
    return by_matrix(pose.at("matrix"), place / "matrix");
  return trajectories.at(pose.at("trajectory").get<std::string>())->at(time_s);
}

// Calls `visit` with the name of each trajectory and its place in the setup.
template <class Visit>
void for_each_trajectory(const ordered_json &setup, const Place &root, const Visit &visit) {
  const auto look_at = [&](const ordered_json &holder, const Place &place) {
    if (holder.contains("trajectory"))
      visit(holder.at("trajectory").get<std::string>(), place / "trajectory");
  };
  for (const char *list : {"sensors", "illuminators"})
    for (std::size_t i = 0; i < setup.at(list).size(); ++i)
      look_at(setup.at(list).at(i).at("pose"), root / list / i / "pose");
  for (const auto &[name, node] : setup.at("nodes").items())
    look_at(node.at("pose"), root / "nodes" / name / "pose");
  look_at(setup.at("frames"), root / "frames");
}

} // namespace

Pose world_from_frame(const ordered_json &pose, const Place &place, const Surroundings &at,
                      const std::vector<Sensor> &sensors) {
  if (pose.contains("node"))
    return at_node(pose.at("node"), place / "node", at.scene);
  if (pose.contains("sensor"))
    return at_sensor(pose.at("sensor"), place / "sensor", sensors);
  return pose.contains("position_m") ? looking_at(pose, place)
                                     : free_pose(pose, place, at.trajectories, at.time_s);
}

std::vector<PlacedNode> placed_nodes(const ordered_json &setup, const Place &root,
                                     const Trajectories &trajectories, double time_s) {
  std::vector<PlacedNode> placed;
  for (const auto &[name, node] : setup.at("nodes").items()) {
    const Place place = root / "nodes" / name;
    placed.push_back({name, free_pose(node.at("pose"), place / "pose", trajectories, time_s), place});
  }
  return placed;
}

Trajectories read_trajectories(const ordered_json &setup, const Place &root) {
  Trajectories trajectories;
  for_each_trajectory(setup, root, [&](const std::string &name, const Place &place) {
    if (!trajectories.contains(name))
      trajectories[name] = std::make_shared<const Trajectory>(read_trajectory(root.folder / name, place));
  });
  return trajectories;
}

Motion::Motion(SceneAtTime scene, Trajectories trajectories, nlohmann::ordered_json setup, Place root)
    : scene_(std::move(scene)), trajectories_(std::move(trajectories)), setup_(std::move(setup)),
      root_(std::move(root)) {}

// A setup that is right at rest may go wrong in motion: such an error tells when.
Instant Motion::at(double time_s, const Instant &start) const {
  try {
    return placed_at(time_s, start);
  } catch (const Error &error) {
    throw Error(error.code(), fmt::format("{}, at {:.6g} s", error.what(), time_s), error.where());
  }
}

Instant Motion::placed_at(double time_s, const Instant &start) const {
  GltfScene moved = scene_(time_s);
  Instant instant{{}, start.sensors, start.illuminators, start.others};
  const auto pose_of = [&](const char *list, std::size_t i) {
    return world_from_frame(setup_.at(list).at(i).at("pose"), root_ / list / i / "pose",
                            {moved, trajectories_, time_s}, instant.sensors);
  };
  for (std::size_t i = 0; i < instant.sensors.size(); ++i)
    instant.sensors[i].world_from_camera = pose_of("sensors", i);
  std::size_t own = 0, other = 0;
  for (std::size_t i = 0; i < setup_.at("illuminators").size(); ++i) {
    Illuminator &illuminator = is_of_another(setup_.at("illuminators").at(i))
                                   ? instant.others[other++].illuminator
                                   : instant.illuminators[own++];
    illuminator.world_from_illuminator = pose_of("illuminators", i);
  }
  instant.scene = std::move(moved.scene);
  return instant;
}

} // namespace pmdsim
