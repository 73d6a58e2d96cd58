#pragma once
// The poses that a setup gives to its sensors and illuminators.

#include "engine/model/pose.h"
#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/loader.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace pmdsim {

// World from the frame (x right, y down, z forward) that `pose` gives: {"node"}, {"position_m", "look_at_m",
// "up"}, or
// {"sensor"} for one of `sensors`. Scale and shear of a node's transform are taken out, its view direction is
// kept. Throws Error (input) at `place`: unknown node or sensor, a view or an up without a direction, a
// mirrored node or one outside the world.
Pose world_from_frame(const nlohmann::ordered_json &pose, const Place &place, const GltfScene &scene,
                      const std::vector<Sensor> &sensors);

} // namespace pmdsim
