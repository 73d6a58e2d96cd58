#include "host/input/file/json_file.h"
#include "host/input/schema/limits.h"
#include "host/input/setup/free_pose.h"
#include "host/input/setup/parts.h"
#include "host/input/setup/rotations.h"
#include "host/input/words/near_name.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <utility>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

Pose looking_at(const ordered_json &pose, const Place &place) {
  const auto position_m = pose.at("position_m").get<glm::dvec3>();
  const auto forward = direction_of(pose.at("look_at_m").get<glm::dvec3>() - position_m);
  if (!forward)
    throw input_error(place / "look_at_m", "expected a point other than position_m, found the same");
  const auto up = direction_of(pose.at("up").get<glm::dvec3>());
  if (!up)
    throw input_error(place / "up", "expected a direction, found zero");
  const glm::dvec3 right = glm::cross(*forward, *up);
  if (glm::length(right) < smallest_sine)
    throw input_error(place / "up", "expected a direction across the view, found one along it");
  const glm::dvec3 x = glm::normalize(right);
  return {glm::dmat3(x, glm::cross(*forward, x), *forward), position_m};
}

bool is_of_sensor(const Place &place) { return place.pointer.to_string().starts_with("/sensors/"); }

Pose at_node(const std::string &name, const Place &place, const GltfScene &scene) {
  const std::string quoted = in_quotes(name), file = scene.file.string();
  if (scene.file.empty())
    throw input_error(place, fmt::format("the setup has no \"scene\", of which {} could be a node; expected "
                                         "another kind of pose, or a scene",
                                         quoted));
  const auto node = std::ranges::find(scene.nodes, name, &NamedNode::name);
  if (node == scene.nodes.end())
    throw input_error(
        place, (is_of_sensor(place) ? absent_camera_text : absent_node_text)(name, scene.file, scene.nodes));
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
  if (sensor == sensors.end()) {
    std::vector<std::string> names;
    for (const Sensor &each : sensors)
      names.push_back(each.name);
    const std::string meant = did_you_mean(name, names);
    throw input_error(place, fmt::format("no sensor {} in this setup{}", in_quotes(name),
                                         meant.empty() ? "; expected " + listed_names(names) : meant));
  }
  return sensor->world_from_camera;
}

// Calls `visit` with the name of each trajectory and its place in the setup.
void for_each_trajectory_of(const ordered_json &setup, const Place &root, const TrajectoryVisit &visit) {
  for (const char *list : {"sensors", "illuminators"})
    for (std::size_t i = 0; i < setup.at(list).size(); ++i)
      for_each_trajectory(setup.at(list).at(i).at("pose"), root / list / i / "pose", visit);
  for (const auto &[name, node] : setup.at("nodes").items())
    for_each_trajectory(node.at("pose"), root / "nodes" / name / "pose", visit);
  for_each_trajectory(setup.at("frames"), root / "frames", visit);
}

} // namespace

Pose world_from_frame(const ordered_json &pose, const Place &place, const Surroundings &at,
                      const std::vector<Sensor> &sensors) {
  if (pose.contains("sensor"))
    return at_sensor(pose.at("sensor"), place / "sensor", sensors);
  if (pose.contains("look_at_m"))
    return looking_at(pose, place);
  return free_pose(pose, place, at.trajectories, at.time_s,
                   [&](const ordered_json &other, const Place &there) {
                     return at_node(other.at("node"), there / "node", at.scene);
                   });
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
  std::size_t poses = 0;
  for_each_trajectory_of(setup, root, [&](const std::string &name, const Place &place) {
    if (trajectories.contains(name))
      return;
    trajectories[name] = std::make_shared<const Trajectory>(read_trajectory(root.folder / name, place));
    poses += trajectories[name]->times_s.size();
    if (poses > max_setup_poses)
      throw input_error(place, fmt::format("expected at most {} poses in all trajectories", max_setup_poses));
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
