#pragma once
// What a setup file may say and the simulator cannot do yet: refused by name, never ignored.

#include "host/input/input_error.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

// `setup` has its defaults filled in. Throws Error (input) at the first key whose value is not supported yet.
void refuse_unsupported(const nlohmann::ordered_json &setup, const Place &root);

} // namespace pmdsim
