#include "host/input/setup/pose.h"

#include "host/input/schema/limits.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace pmdsim {

using nlohmann::ordered_json;

namespace {

constexpr double smallest_sine = 1e-9; // directions closer than this, in radians, count as parallel

glm::dvec3 vector_of(const ordered_json &numbers) {
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

// Unit vector along `v`; nothing where `v` has no direction. Free of overflow and underflow.
std::optional<glm::dvec3> direction_of(const glm::dvec3 &v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0) || !std::isfinite(largest))
    return std::nullopt;
  return glm::normalize(v / largest);
}

Pose looking_at(const ordered_json &pose, const Place &place) {
  const glm::dvec3 position_m = vector_of(pose.at("position_m"));
  const auto forward = direction_of(vector_of(pose.at("look_at_m")) - position_m);
  if (!forward)
    throw input_error(place / "look_at_m", "expected a point other than position_m");
  const auto up = direction_of(vector_of(pose.at("up")));
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
  const auto is_named = [&](const NamedNode &node) { return node.name == name; };
  const auto node = std::find_if(scene.nodes.begin(), scene.nodes.end(), is_named);
  if (node == scene.nodes.end())
    throw input_error(place, fmt::format("no node {} in {}", in_quotes(name), scene.file.string()));
  if (std::find_if(std::next(node), scene.nodes.end(), is_named) != scene.nodes.end())
    throw input_error(place,
                      fmt::format("more than one node {} in {}", in_quotes(name), scene.file.string()));
  if (!is_position(node->world_from_node.translation_m))
    throw input_error(place,
                      fmt::format("node {} lies outside the world, expected coordinates from {} to {} m",
                                  in_quotes(name), -max_coordinate_m, max_coordinate_m));
  const auto rotation = rotation_of(node->world_from_node.linear);
  if (!rotation)
    throw input_error(place,
                      fmt::format("the transform of node {} is mirrored or singular", in_quotes(name)));
  return compose({*rotation, node->world_from_node.translation_m}, node_from_camera());
}

Pose at_sensor(const std::string &name, const Place &place, const std::vector<Sensor> &sensors) {
  const auto sensor = std::find_if(sensors.begin(), sensors.end(),
                                   [&](const Sensor &candidate) { return candidate.name == name; });
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

} // namespace pmdsim
