#pragma once
// A setup's cameras.

#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/loader.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

// `sensor` is an element of the setup's /sensors, `place`, with its defaults filled in. Throws Error (input):
// also for a distortion that folds over inside the image and a chip that is not in front of the lens.
Sensor sensor_of(const nlohmann::ordered_json &sensor, const Place &place, const GltfScene &scene);

} // namespace pmdsim
