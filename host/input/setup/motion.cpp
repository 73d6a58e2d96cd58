#include "host/input/setup/motion.h"

#include "host/input/setup/pose.h"

#include <fmt/format.h>
#include <utility>

namespace pmdsim {

Motion::Motion(GltfFile gltf, nlohmann::ordered_json setup, Place root)
    : gltf_(std::move(gltf)), setup_(std::move(setup)), root_(std::move(root)) {}

// What is right at rest may go wrong in motion: such an error tells when.
Instant Motion::at(double time_s, const Instant &start) const {
  try {
    return placed_at(time_s, start);
  } catch (const Error &error) {
    throw Error(error.code(), fmt::format("{}, at {:.6g} s", error.what(), time_s));
  }
}

Instant Motion::placed_at(double time_s, const Instant &start) const {
  GltfScene moved = gltf_.at(time_s);
  Instant instant{{}, start.sensors, start.illuminators};
  const auto pose_of = [&](const char *list, std::size_t i) {
    return world_from_frame(setup_.at(list).at(i).at("pose"), root_ / list / i / "pose", moved,
                            instant.sensors);
  };
  for (std::size_t i = 0; i < instant.sensors.size(); ++i)
    instant.sensors[i].world_from_camera = pose_of("sensors", i);
  for (std::size_t i = 0; i < instant.illuminators.size(); ++i)
    instant.illuminators[i].world_from_illuminator = pose_of("illuminators", i);
  instant.scene = std::move(moved.scene);
  return instant;
}

} // namespace pmdsim
