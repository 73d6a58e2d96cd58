#pragma once
// Which objects of a glTF document refer to which, by index, and the features that are not there yet.

#include "host/input/file/input_error.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

// Throws Error (input) where an index names nothing or a feature is used that is not supported yet.
// `document` has passed the glTF schema.
void check_references(const nlohmann::json &document, const Place &root);

} // namespace pmdsim
