#pragma once
// The extensions that a glTF file may require.

#include "host/input/file/input_error.h"

#include <nlohmann/json.hpp>

namespace pmdsim {

// Throws Error (input) at the first required extension without which the file would be another scene here.
void refuse_other_extensions(const nlohmann::json &document, const Place &root);

} // namespace pmdsim
