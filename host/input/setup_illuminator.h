#pragma once
// The diodes of a setup's illuminator.

#include "engine/illuminator.h"
#include "host/input/input_error.h"

#include <nlohmann/json.hpp>
#include <vector>

namespace pmdsim {

// `illuminator` is an element of the setup's /illuminators, `place`, with its defaults filled in. Returns 1
// to 100,000 diodes in the illuminator's frame: ring by ring in the order of their angles, or in the diode
// file's order. Throws Error (input).
std::vector<Diode> diodes_of(const nlohmann::ordered_json &illuminator, const Place &place);

} // namespace pmdsim
