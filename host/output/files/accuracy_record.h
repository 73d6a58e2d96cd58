#pragma once
// What is written of how exact frames are.

#include "engine/model/accuracy.h"

#include <nlohmann/json.hpp>
#include <string>

namespace pmdsim {

// As the command line has them: "exact", "reduced", "auto"; "fp32", "fp64".
std::string mode_name(Mode mode);
std::string precision_name(Precision precision);

// precision, diodes (as AccuracyReport::diodes), error_claimed_m, error_found_m, amplitude_error_claimed,
// amplitude_error_found (relative), checked_pixels, check_ms. An error is null where nothing is known of it.
nlohmann::ordered_json accuracy_json(const AccuracyReport &report);

} // namespace pmdsim
