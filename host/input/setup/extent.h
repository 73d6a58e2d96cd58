#pragma once
// How much a setup may hold: work and messages take a time for each value, and for each pair of entries of an
// object.

#include "host/input/file/input_error.h"

#include <cstddef>
#include <nlohmann/json.hpp>

namespace pmdsim {

inline constexpr std::size_t max_setup_entries = std::size_t{1} << 12; // of each list and each object
inline constexpr std::size_t max_setup_values = std::size_t{1} << 16;

// Throws Error (input) where a document has more.
void check_extent(const nlohmann::json &document, const Place &root);

} // namespace pmdsim
