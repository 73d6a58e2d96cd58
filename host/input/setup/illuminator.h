#pragma once
// The illuminators of a setup.

#include "engine/model/illuminator.h"
#include "engine/model/sensor.h"
#include "host/input/file/input_error.h"
#include "host/input/gltf/loader.h"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pmdsim {

// `illuminators` is the setup's /illuminators, `place`, with their defaults filled in. At most 100,000 diodes
// in all. Appends to `warnings`, one line each, what is odd about their diagrams. Throws Error (input).
std::vector<Illuminator> illuminators_of(const nlohmann::ordered_json &illuminators, const Place &place,
                                         const GltfScene &scene, const std::vector<Sensor> &sensors,
                                         std::vector<std::string> &warnings);

} // namespace pmdsim
