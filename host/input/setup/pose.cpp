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

} // namespace

Pose world_from_frame(const ordered_json &pose, const Place &place, const GltfScene &scene,
                      const std::vector<Sensor> &sensors) {
  if (pose.contains("node"))
    return at_node(pose.at("node"), place / "node", scene);
  if (pose.contains("sensor"))
    return at_sensor(pose.at("sensor"), place / "sensor", sensors);
  return looking_at(pose, place);
}

Motion::Motion(GltfFile gltf, nlohmann::ordered_json setup, Place root)
    : gltf_(std::move(gltf)), setup_(std::move(setup)), root_(std::move(root)) {}

// A setup that is right at rest may go wrong in motion: such an error tells when.
Instant Motion::at(double time_s, const Instant &start) const {
  try {
    return placed_at(time_s, start);
  } catch (const Error &error) {
    throw Error(error.code(), fmt::format("{}, at {:.6g} s", error.what(), time_s));
  }
}

Instant Motion::placed_at(double time_s, const Instant &start) const {
  GltfScene moved = gltf_.at(time_s);
  Instant instant{{}, start.sensors, start.illuminators, start.others};
  const auto pose_of = [&](const char *list, std::size_t i) {
    return world_from_frame(setup_.at(list).at(i).at("pose"), root_ / list / i / "pose", moved,
                            instant.sensors);
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
